// SPDX-License-Identifier: GPL-3.0-or-later
// Samples where cells cut a surface.
#include <cmath>
#include <set>

#include "support/surfaces.h"
#include "volume/cut_surface.h"
#include "volume/volume_test.h"

namespace opaline {
namespace {

using namespace test;

std::vector<std::uint32_t> all_meshes(const World& world) {
  std::vector<std::uint32_t> meshes;
  for (std::uint32_t m = 0; m < world.meshes.size(); ++m) meshes.push_back(m);
  return meshes;
}

CutSurface cut(const World& world, double cell_mm, int parts = 1) {
  return cut_surface(world, all_meshes(world), cell_mm / world.unit, parts);
}

double area_of(const World& world) {
  double area = 0;
  for (const MeshMeasures& measures : world.measures) area += measures.area;
  return area;
}

// Claim: samples share out all of the surface, stand within a cell of the middle of what they stand for, on its sheet, and
// are no more than the plan expects, four times as many for half the edge. Source: the header; a plane at random meets 1.5
// cells for each face's area. Tolerance: 1e-5 of the area; 16 % of the number. Fails if: parts of triangles are lost,
// counted twice, or put to another sheet's sample.
TEST(CutSurface, SharesOutTheSurface) {
  for (const ShapeSource& shape : {ShapeSource(SphereShape{{}, 5}), ShapeSource(TorusShape{{}, 5, 2})}) {
    const World world = world_of({shape});
    for (const int parts : {1, 2}) {
      constexpr double kCell = .5;
      const CutSurface found = cut(world, kCell, parts);
      const double edge = kCell / world.unit / parts;
      double area = 0;
      for (std::size_t i = 0; i < found.surface.samples.size(); ++i) {
        const SurfaceSample& s = found.surface.samples[i];
        area += double(s.area);
        EXPECT_LT(length(s.position - s.centroid), edge);
        EXPECT_GT(dot(s.normal, found.normals[i]), .8f);
      }
      EXPECT_NEAR(area / area_of(world), 1, 1e-5);
      EXPECT_NEAR(found.surface.area / area_of(world), 1, 1e-5);
      const double expected = kCutSamplesPerFace * area / (edge * edge);
      EXPECT_LT(double(found.surface.samples.size()), expected);
      EXPECT_GT(double(found.surface.samples.size()), .84 * expected);
    }
  }
}

/// Levels along y at which samples stand, by a tenth of a mm.
std::set<int> levels_of(const World& world, const CutSurface& found) {
  std::set<int> levels;
  for (const SurfaceSample& s : found.surface.samples)
    levels.insert(int(std::lround(10 * out_of_world(world, Vec3d(s.centroid)).y)));
  return levels;
}

// Claim: sheets in one cell have samples of their own: the sides of a thin plate, and two plates' faces that look the same
// way. Source: cut_surface.h. Fails if: elements are told by their cell alone, or by cell and normal (levels between).
TEST(CutSurface, EachSheetHasItsOwn) {
  for (const double cell : {2., 3.1}) {
    const World plate = world_of({SlabShape{{}, 20, 20, .4}}, NormalMode::faceted);
    const CutSurface of_plate = cut(plate, cell);
    for (const SurfaceSample& s : of_plate.surface.samples)
      if (std::abs(s.normal.y) > .5f) {
        EXPECT_NEAR(std::abs(out_of_world(plate, Vec3d(s.centroid)).y), .2, 1e-3);
        EXPECT_GT(s.normal.y * s.centroid.y, 0);
      }
    const World two = world_of(
        {QuadShape{{-10, 0, -10}, {0, 0, 20}, {20, 0, 0}}, QuadShape{{-10, 1, -10}, {0, 0, 20}, {20, 0, 0}}},
        NormalMode::faceted);
    EXPECT_EQ(levels_of(two, cut(two, cell)), (std::set<int>{0, 10})) << cell;
  }
}

}  // namespace
}  // namespace opaline
