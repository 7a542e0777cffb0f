// SPDX-License-Identifier: GPL-3.0-or-later
// The cut surface of a solid whose meshes overlap, fold back or lie within each other.
#include <cmath>
#include <numbers>

#include "opaline/volume/cell_fit.h"
#include "opaline/volume/cut_outer_surface.h"
#include "volume/diffused_body.h"

namespace opaline {
namespace {

using namespace test;

constexpr double kRadius = 10;

/// Vertices of a ball dragged across their neighbours, as scans have them: 12, spread over it.
World folded_ball() {
  World world = world_of({SphereShape{{}, kRadius, kLeastFineness}});
  Mesh& mesh = world.meshes[0];
  const std::vector<Vec3d> before = mesh.positions;
  for (std::size_t i = 0; i < 12; ++i) {
    const auto& triangle = mesh.triangles[(2 * i + 1) * mesh.triangles.size() / 24];
    const Vec3d step = before[triangle[1]] - before[triangle[0]];
    mesh.positions[triangle[0]] += step * 2.5;
  }
  world.measures[0] = measures_of(mesh);
  return world;
}

/// mm^2
double outer_area(const World& world, double cell_mm) {
  const RayScene rays(world);
  std::vector<std::uint32_t> meshes(world.meshes.size());
  std::iota(meshes.begin(), meshes.end(), 0u);
  const CutSurface found = cut_outer_surface(rays, world, meshes, cell_mm / world.unit, 1);
  double area = 0;
  for (const SurfaceSample& sample : found.surface.samples) area += double(sample.area);
  EXPECT_NEAR(found.surface.area / area, 1, 1e-5);
  return area * world.unit * world.unit;
}

double ball_area(double radius) {
  return 4 * std::numbers::pi * radius * radius;
}

// Claim: what bounds the solid is counted once: not the part of a ball in another, a ball in a ball, or the second of two
// balls in one place. Source: by hand, caps of two balls whose centres are as far apart as the radius. Tolerance: 2 % of the
// overlap where balls cross within cells, else the triangles' .02 %. Fails if: pieces inside stay, or both copies go.
TEST(OuterSurface, CountsEachPieceOnce) {
  const SphereShape ball{{}, kRadius}, beside{{kRadius, 0, 0}, kRadius}, within{{1, 0, 0}, kRadius / 2};
  EXPECT_NEAR(outer_area(world_of({ball}), .8) / ball_area(kRadius), 1, 1e-3);
  EXPECT_NEAR(outer_area(world_of({ball, beside}), .8) / (1.5 * ball_area(kRadius)), 1, .01);
  EXPECT_NEAR(outer_area(world_of({ball, within}), .8) / ball_area(kRadius), 1, 1e-3);
  EXPECT_NEAR(outer_area(world_of({ball, ball}), .8) / ball_area(kRadius), 1, 1e-3);
  World hollow = world_of({ball, within});
  for (auto& triangle : hollow.meshes[1].triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_NEAR(outer_area(hollow, .8) / ball_area(kRadius), 1.25, 1e-3) << "a cavity is a boundary";
}

// Claim: meshes without such pieces have the samples of cut_surface, bit for bit, thin parts and sharp edges too. Source:
// the header. Fails if: thin plates are taken for folds.
TEST(OuterSurface, LeavesCleanMeshesAlone) {
  const std::vector<ShapeSource> shapes{SphereShape{{}, 5}, TorusShape{{}, 5, .3}, SlabShape{{}, 10, 8, .2},
                                        BoxShape{{-3, -2, -1}, {3, 2, 1}}};
  for (const ShapeSource& shape : shapes) {
    const World world = world_of({shape});
    const RayScene rays(world);
    const std::uint32_t mesh = 0;
    const double cell = .8 / world.unit;
    const CutSurface plain = cut_surface(world, {&mesh, 1}, cell, 2),
                     outer = cut_outer_surface(rays, world, {&mesh, 1}, cell, 2);
    ASSERT_EQ(outer.surface.samples.size(), plain.surface.samples.size());
    EXPECT_EQ(std::memcmp(outer.surface.samples.data(), plain.surface.samples.data(),
                          plain.surface.samples.size() * sizeof(SurfaceSample)),
              0);
  }
}

/// Of the exitance at samples in even light from one side, by their direction from the centre: rms of the difference, over
/// the mean; and the largest.
struct Spots {
  double rms = 0, largest = 0;
};

Spots difference_of(const LitBody& body, const VolumeExitance& found, const LitBody& clean,
                         const VolumeExitance& truth) {
  const CellFit fit(clean.surface.samples, truth.exitance, truth.error);
  CellFit::Reader reader(fit);
  double square = 0, mean = 0, area = 0;
  Spots difference;
  for (std::size_t i = 0; i < body.surface.samples.size(); ++i) {
    const SurfaceSample& s = body.surface.samples[i];
    const Vec3f outward = normalized(s.centroid);
    const double expected = double(reader.at(outward * float(kRadius / clean.world.unit), outward).value.x);
    const double apart = double(found.exitance[i].x) - expected, share = double(s.area);
    square += share * apart * apart;
    mean += share * expected;
    area += share;
    difference.largest = std::max(difference.largest, std::abs(apart));
  }
  mean /= area;
  difference.rms = std::sqrt(square / area) / mean;
  difference.largest /= mean;
  return difference;
}

// Claim: a ball whose vertices are dragged across their neighbours has the exitance of the ball, without spots. Tolerance:
// rms 1 % of the mean, and nowhere 10 %. Fails if: every piece counts, or a line through a fold is lost.
TEST(OuterSurface, FoldedBallIsABall) {
  LitBody clean(SphereShape{{}, kRadius, kLeastFineness}, 2000), folded(folded_ball(), 2000);
  const HomogeneousMedium medium{.01, 2, 0, 1.5};
  const DirectionalLight light{normalized(Vec3d(-.3, -1, -.5)), Rgb(1)};
  const VolumeExitance truth = diffused(clean, grey(medium), light, .8);
  const double cell = .8 / folded.world.unit;
  CutSurface cut = cut_outer_surface(folded.rays, folded.world, folded.meshes, cell, 1);
  folded.surface = std::move(cut.surface);
  HomogeneousMedium scaled = medium;
  scaled.sigma_a *= folded.world.unit;
  scaled.sigma_s *= folded.world.unit;
  const VolumeDiffusion cells(
      {folded.world, folded.meshes, folded.surface.samples, cut.normals, grey(scaled), cell});
  const VolumeExitance found =
      cells.exitance(lights_of(folded, light), transfers_of(folded, light, medium.eta));
  const Spots difference = difference_of(folded, found, clean, truth);
  EXPECT_LT(difference.rms, .01);
  EXPECT_LT(difference.largest, .1);
}

}  // namespace
}  // namespace opaline
