// SPDX-License-Identifier: GPL-3.0-or-later
// The cut surface of a solid whose meshes overlap, fold back or lie within each other.
#include <cmath>
#include <numbers>

#include "volume/cut_outer_surface.h"
#include "volume/lit_body.h"

namespace opaline {
namespace {

using namespace test;

constexpr double kRadius = 10;

/// mm^2
/// others: the last meshes, which are not of the body
double outer_area(const World& world, double cell_mm, std::size_t others = 0) {
  const RayScene rays(world);
  std::vector<std::uint32_t> meshes(world.meshes.size() - others);
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

// Claim: what bounds the solid is counted once: not the part of a ball in another, nor a ball in a ball; a cavity is a
// boundary. Source: by hand, caps of two balls whose centres are as far apart as the radius. Tolerance: 1 % where balls cross
// within cells, else the triangles' .02 %. Fails if: pieces inside stay.
TEST(OuterSurface, CountsEachPieceOnce) {
  const SphereShape ball{{}, kRadius}, beside{{kRadius, 0, 0}, kRadius}, within{{1, 0, 0}, kRadius / 2};
  EXPECT_NEAR(outer_area(world_of({ball}), .8) / ball_area(kRadius), 1, 1e-3);
  EXPECT_NEAR(outer_area(world_of({ball, beside}), .8) / (1.5 * ball_area(kRadius)), 1, .01);
  EXPECT_NEAR(outer_area(world_of({ball, within}), .8) / ball_area(kRadius), 1, 1e-3);
  World hollow = world_of({ball, within});
  for (auto& triangle : hollow.meshes[1].triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_NEAR(outer_area(hollow, .8) / ball_area(kRadius), 1.25, 1e-3) << "a cavity is a boundary";
}

// Claim: a box on a floor in the plane of its lower face has all of its area. Source: by hand. Tolerance: rounding. Fails
// if: rays meet the floor alone where both coincide.
TEST(OuterSurface, AFloorHidesNothing) {
  const World world =
      world_of({BoxShape{{-5, 0, -5}, {5, 9, 5}}, QuadShape{{-50, 0, -50}, {0, 0, 100}, {100, 0, 0}}});
  EXPECT_NEAR(outer_area(world, 1.78, 1) / 560, 1, 1e-5);
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

}  // namespace
}  // namespace opaline
