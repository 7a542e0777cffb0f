// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks inside meshes.
#include "transport/fresnel.h"
#include "transport/laboratory.h"
#include "volume/lit_body.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a body that absorbs nothing in the same light from everywhere sends out all that enters, all over its
// surface: a white furnace. Source: conservation; symmetry of the sphere. Tolerance: the mean within 4 standard
// errors and .5 %, cells by their stated errors (reduced chi-square .8 to 1.25 of 500 cells). Fails if: the way
// in has no Ft, reflected light is lost, or cells are not those of the samples' areas.
TEST(VolumeExitance, WhiteFurnace) {
  for (const double eta : {1.0, 1.5}) {
    LitBody body(SphereShape{{}, 4}, 500);
    body.medium = {0, 1, 0, eta};
    body.light({Surroundings{Rgb(1)}});
    const VolumeExitance walked = body.walked();
    const double entered = furnace_exitance(eta);
    const WalkedValue mean = body.mean_where(walked, everywhere);
    EXPECT_NEAR(mean.value / entered, 1, .005 + 4 * mean.error / entered) << eta;
    double chi_square = 0;
    for (std::size_t i = 0; i < walked.exitance.size(); ++i)
      chi_square += std::pow((double(walked.exitance[i].x) - entered) / double(walked.error[i].x), 2);
    EXPECT_NEAR(chi_square / double(walked.exitance.size()), 1, .25) << eta;
    EXPECT_EQ(max_component(walked.lost), 0);
  }
}

// Claim: the middle of a wide plate sends back and lets through what the laboratory's slab does. Source: the same
// walks between two planes. Tolerance: 4 standard errors of both, and 1 %: light that leaves by the rim. Fails
// if: light enters unrefracted, or what crosses unscattered is not counted.
TEST(VolumeExitance, PlateIsTheLaboratorysSlab) {
  const HomogeneousMedium medium{.05, 1, 0, 1.3};
  const double thickness = 2;
  LitBody body(SlabShape{{}, 60, 60, thickness}, 4000, NormalMode::faceted);
  body.medium = medium;
  body.light({DirectionalLight{{0, -1, 0}, Rgb(1)}});
  const VolumeExitance walked = body.walked();
  const auto is_inner = [&](const SurfaceSample& s) {
    const double x = double(s.position.x) * body.world.unit, z = double(s.position.z) * body.world.unit;
    return std::abs(x) < 20 && std::abs(z) < 20;
  };
  const auto top = [&](const SurfaceSample& s) { return s.normal.y > .5f && is_inner(s); };
  const auto bottom = [&](const SurfaceSample& s) { return s.normal.y < -.5f && is_inner(s); };
  const double entered = fresnel_transmittance(1.0, medium.eta);
  LaboratorySettings settings;
  settings.walks = 200000;
  const SlabWalks slab = walk_slab(medium, {thickness}, kNormalEntry, settings);
  const WalkedValue back = body.mean_where(walked, top), through = body.mean_where(walked, bottom);
  const double R = slab.back.total.value, T = slab.through.total.value;
  EXPECT_NEAR(back.value / entered, R, 4 * std::hypot(back.error, slab.back.total.error) + .01 * R);
  EXPECT_NEAR(through.value / entered, T, 4 * std::hypot(through.error, slab.through.total.error) + .01 * T);
}

/// A ball with a hollow of half its radius, which no light reaches but through the body.
World hollow_ball(double radius) {
  Mesh mesh = world_of({SphereShape{{}, radius, 4}}, NormalMode::faceted).meshes[0];
  Bounds box = bounds(mesh);
  const double scale = 2 * radius / (box.high.x - box.low.x);
  for (Vec3d& p : mesh.positions) p *= scale;
  const auto corners = std::uint32_t(mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  for (std::uint32_t i = 0; i < corners; ++i) mesh.positions.push_back(mesh.positions[i] * .5);
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    mesh.triangles.push_back({corners + i, corners + k, corners + j});
  }
  return world_of_mesh(std::move(mesh));
}

/// Every cell of a body without absorption in the same light from everywhere sends out all that would enter there if
/// nothing were in the way.
void expect_furnace(const LitBody& body, const std::string& what) {
  const VolumeExitance walked = body.walked();
  const double expected = furnace_exitance(body.medium.eta);
  double chi_square = 0;
  for (std::size_t i = 0; i < walked.exitance.size(); ++i)
    chi_square += std::pow((double(walked.exitance[i].x) - expected) / double(walked.error[i].x), 2);
  const double cells = double(walked.exitance.size());
  const WalkedValue mean = body.mean_where(walked, everywhere);
  EXPECT_NEAR(mean.value / expected, 1, .005 + 4 * mean.error / expected) << what;
  EXPECT_NEAR(chi_square / cells, 1, .4) << what;  // of 16 passes: 1.15, its spread .06
}

// Claim: where light that has left may enter again, a white furnace is one for any shape: beside a reentrant edge, and in
// a hollow that light reaches through the body alone. Without, the hollow and the edge stay darker. Source: the second
// law: nothing in an oven of one temperature is brighter or darker than the rest. Tolerance: the mean as in WhiteFurnace,
// cells by their stated errors. Fails if: light that leaves ends outside, lamps' light that the boundary reflects does,
// or the boundary's F is left out outside.
TEST(VolumeExitance, WhiteFurnaceOfAnyShape) {
  const std::pair<std::string, World> shapes[] = {
      {"overlapping boxes",
       world_of({BoxShape{{-3, -3, -2}, {0, 3, 2}}, BoxShape{{-1, -2.5, -1.5}, {3, -1, 1.5}}},
                NormalMode::faceted)},
      {"torus", world_of({TorusShape{{}, 3, 1.2, 4}}, NormalMode::faceted)},
      {"hollow ball", hollow_ball(4)}};
  for (const auto& [name, world] : shapes) {
    LitBody body(world, 300);
    body.medium = {0, 1, 0, 1.4};
    body.light({Surroundings{Rgb(1)}});
    if (name != "overlapping boxes") expect_furnace(body, name);  // cells of hidden sheets are black
    const double with = body.mean_where(body.walked(), everywhere).value;
    body.reenter = false;
    const double without = body.mean_where(body.walked(), everywhere).value;
    EXPECT_LT(without, .97 * with) << name;
  }
}

// Claim: a convex body is the same, byte for byte, with and without light that enters again. Source: nothing that leaves
// it meets it. Fails if: the choice takes random numbers from the walk, or rays from the surface meet it.
TEST(VolumeExitance, ConvexBodiesKnowNoReentry) {
  for (const bool is_box : {true, false}) {
    LitBody body(is_box ? ShapeSource(BoxShape{{-2, -1, -1}, {2, 1, 1}}) : ShapeSource(SphereShape{{}, 2, 4}),
                 100, NormalMode::faceted);
    body.medium = {.05, 1, 0, 1.4};
    body.light({PointLight{{0, 20, 5}, Rgb(1)}});
    const VolumeExitance with = body.walked();
    body.reenter = false;
    const VolumeExitance without = body.walked();
    EXPECT_EQ(with.exitance, without.exitance);
    EXPECT_EQ(with.error, without.error);
  }
}

// Claim: as many walks as an error takes, and the same bytes for 1 and 3 threads. Source: the header. Tolerance:
// none. Fails if: batches are summed as they end.
TEST(VolumeExitance, UntilErrorAndThreads) {
  LitBody body(SphereShape{{}, 4}, 200);
  body.medium = {.1, 1, .5, 1.4};
  body.light({PointLight{{0, 20, 0}, Rgb(1)}});
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return body.walked(7, .2);
  };
  const VolumeExitance one = run(1), three = run(3);
  EXPECT_LE(one.relative_error, .2);
  EXPECT_EQ(one.exitance, three.exitance);
  EXPECT_EQ(one.error, three.error);
}

}  // namespace
}  // namespace opaline
