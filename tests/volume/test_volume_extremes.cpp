// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks in bodies and media at the ends of their ranges.
#include "support/statistics.h"
#include "volume/lit_body.h"

namespace opaline {
namespace {

using namespace test;

/// Light that leaves over light that enters; every value must be finite.
double albedo_of(const LitBody& body, const std::string& what) {
  const VolumeInput input = body.input();
  VolumeSums sums;
  walk_volume(input, sums);
  const VolumeExitance walked = exitance_of(input, sums);
  double leaves = 0;
  for (std::size_t i = 0; i < walked.exitance.size(); ++i) {
    EXPECT_TRUE(is_finite(walked.exitance[i]) && is_finite(walked.error[i])) << what;
    EXPECT_GE(min_component(walked.exitance[i]), 0) << what;
    leaves += double(walked.exitance[i].x) * double(body.surface.samples[i].area);
  }
  EXPECT_TRUE(std::isfinite(walked.relative_error)) << what;
  const WalkSums& first = sums.sources.at(0).channels[0];
  if (first.passes == 0) return 0;
  const double start = body.surface.area / double(4 * body.surface.samples.size());
  return leaves / (first.entered * start / double(first.passes));
}

// Claim: nothing is NaN, negative or more than entered, for any absorption, scattering far forward and backward, and
// boundaries from .75 to 3; without absorption all comes out. Source: conservation. Tolerance: five standard errors,
// some 2 %, and where nothing absorbs behind eta 3, where walks are thousands of collisions long, 6 %. Fails if: a walk
// that is given up counts as lost light, or the flight without a wall divides by what is 0.
TEST(VolumeExtremes, Media) {
  for (const double sigma_a : {0., .1, 30.})
    for (const double sigma_s : {0., 1.})
      for (const double g : {-.95, 0., .95})
        for (const double eta : {.75, 1., 3.}) {
          LitBody body(SphereShape{{}, 2, 4}, 40, NormalMode::faceted);
          body.medium = {sigma_a, sigma_s, g, eta};
          body.light({Surroundings{Rgb(1)}});
          const std::string what = testing::PrintToString(std::array{sigma_a, sigma_s, g, eta});
          const double albedo = albedo_of(body, what);
          EXPECT_LE(albedo, 1.06) << what;
          if (sigma_s == 0) {
            EXPECT_EQ(albedo, 0) << what;
          } else if (sigma_a == 0) {
            EXPECT_NEAR(albedo, 1, .06) << what;
          }
        }
}

// Claim: the same for meshes that are no body's: open, crossing themselves, shells in shells, parts that touch, and other
// shapes inside or beside; what is wrong is told. Source: walk_volume. Tolerance: none but what leaves: at most what
// entered, within 5 %. Fails if: a ray that meets nothing goes on for ever, or sheets of one place are crossed again and
// again.
TEST(VolumeExtremes, Meshes) {
  struct Case {
    std::string name;
    World world;
    std::size_t others = 0;
    bool loses = false, stops = false, has_sheets = false;
  };
  Mesh crossing = world_of({TorusShape{{}, 1, 1.5, 4}}, NormalMode::faceted).meshes[0];
  const auto boxes = [](const BoxShape& a, const BoxShape& b) {
    return world_of({a, b}, NormalMode::faceted);
  };
  const BoxShape unit{{-1, -1, -1}, {1, 1, 1}};
  std::vector<Case> cases;
  cases.push_back({"quad", world_of({floor_quad(2)}), 0, true, false, false});
  cases.push_back({"torus that crosses itself", world_of_mesh(std::move(crossing)), 0, false, false, true});
  cases.push_back({"shell in a shell", boxes({{-2, -2, -2}, {2, 2, 2}}, unit), 0, false, false, true});
  cases.push_back({"touching parts", boxes(unit, {{1, -1, -1}, {3, 1, 1}}), 0, false, false, true});
  cases.push_back({"the same part twice", boxes(unit, unit), 0, false, false, true});
  cases.push_back({"touching another body", boxes(unit, {{1, -1, -1}, {3, 1, 1}}), 1, false, false, false});
  cases.push_back({"another body inside", boxes({{-2, -2, -2}, {2, 2, 2}}, unit), 1, false, true, false});
  for (Case& one : cases) {
    LitBody body(std::move(one.world), 60, one.others);
    body.medium = {.05, 1, 0, 1.3};
    body.light({DirectionalLight{normalized(Vec3d{1, -2, .5}), Rgb(1)}, PointLight{{0, 9, 3}, Rgb(9)}});
    body.reenter = false;
    const double albedo = albedo_of(body, one.name);
    EXPECT_LE(albedo, 2.05) << one.name;  // of two lights' light that of one
    const VolumeExitance walked = body.walked();
    EXPECT_EQ(max_component(walked.lost) > 1e-3, one.loses) << one.name << ' ' << max_component(walked.lost);
    EXPECT_EQ(max_component(walked.stopped) > 1e-3, one.stops)
        << one.name << ' ' << max_component(walked.stopped);
    EXPECT_EQ(!walked.outer_shares.empty(), one.has_sheets) << one.name;
  }
}

// Claim: two boxes that touch are one box of their size: light goes through where they meet. Source: the union has no
// boundary there. Tolerance: 4 standard errors of the flux through the far end. Fails if: the sheets between them
// reflect, or count as left.
TEST(VolumeExtremes, TouchingPartsAreOneBody) {
  const auto far_end = [](const std::vector<ShapeSource>& shapes) {
    LitBody body(world_of(shapes, NormalMode::faceted), 400);
    body.medium = {.02, 1, 0, 1.3};
    body.light({DirectionalLight{{1, 0, 0}, Rgb(1)}});
    Mean mean;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      const VolumeExitance walked = body.walked(seed);
      mean.add(
          body.mean_where(walked, [](const SurfaceSample& s) { return s.normal.x > .5f && s.position.x > 0; })
              .value);
    }
    return mean;
  };
  const Mean one = far_end({BoxShape{{-2, -1, -1}, {2, 1, 1}}}),
             two = far_end({BoxShape{{-2, -1, -1}, {0, 1, 1}}, BoxShape{{0, -1, -1}, {2, 1, 1}}});
  EXPECT_NEAR(one.mean(), two.mean(), 4 * std::hypot(one.error(), two.error()));
  EXPECT_LT(one.error(), .03 * one.mean());
}

}  // namespace
}  // namespace opaline
