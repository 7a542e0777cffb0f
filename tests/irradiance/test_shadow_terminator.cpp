// SPDX-License-Identifier: GPL-3.0-or-later
// The edge between light and shadow on coarse meshes with smooth normals.
#include <gtest/gtest.h>

#include <map>

#include "support/lighting.h"
#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

/// Icosahedron with each triangle divided into four this many times, vertices on a sphere of radius 10.
Mesh ball(int divisions, bool is_smooth = true) {
  constexpr double g = std::numbers::phi;
  Mesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < divisions; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), mesh.positions.size());
      if (is_new) mesh.positions.push_back(normalized(mesh.positions[a]) + normalized(mesh.positions[b]));
      return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> divided;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t x = middle(a, b), y = middle(b, c), z = middle(c, a);
      divided.insert(divided.end(), {{a, x, z}, {b, y, x}, {c, z, y}, {x, y, z}});
    }
    mesh.triangles = divided;
  }
  for (Vec3d& p : mesh.positions) {
    p = normalized(p) * 10.0;
    if (is_smooth) mesh.normals.push_back(Vec3f(normalized(p)));
  }
  return mesh;
}

/// Points spread over the triangles of mesh 0.
std::vector<SurfacePoint> points_over(const LitWorld& lit) {
  std::vector<SurfacePoint> points;
  for (std::uint32_t t = 0; t < lit.world.meshes[0].triangles.size(); ++t)
    for (const auto& [u, v] : {std::pair(.05f, .05f), {.9f, .05f}, {.05f, .9f}, {.34f, .32f}, {.5f, .45f}})
      points.push_back(lit.rays.surface_point(0, t, u, v));
  return points;
}

std::vector<float> weights_at(const LitWorld& lit, const std::vector<SurfacePoint>& points,
                              const Light& light) {
  const std::vector<std::uint64_t> keys(points.size());
  return transfers_at({lit.rays, points, keys, {&light, 1}})[0].weights;
}

/// Largest error over points of a ball alone, relative to the light at a normal towards the light.
double largest_error(const std::vector<float>& weights, const auto& points, const Vec3d& light) {
  double error = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Vec3d to = light - Vec3d(points[i].position);
    const double expected = std::max(0.0, dot(Vec3d(points[i].normal), normalized(to))) / dot(to, to);
    error = std::max(error, std::abs(double(weights[i]) - expected) * dot(light, light));
  }
  return error;
}

constexpr Vec3d kSide{100, 40, 10};

// Claim: a ball of 320 triangles has light wherever its normals face the light, as one of 20,480 has, at points and at
// samples, and also on the back of a mesh turned inside out. Source: a sphere shades no point facing the light.
// Tolerance: .001 of the light at a normal towards it; .14 without a lift. Fails if: rays begin on the triangles, or
// triangles facing away stay dark.
TEST(ShadowTerminator, OfACoarseBallIsThatOfAFineOne) {
  const Light light = unit_point(kSide);
  for (const int divisions : {2, 5}) {
    const LitWorld lit(world_of_mesh(ball(divisions)));
    const std::vector<SurfacePoint> points = points_over(lit);
    EXPECT_LT(largest_error(weights_at(lit, points, light), points, kSide), .001) << divisions;
    const std::vector<SurfaceSample> samples = samples_on(lit.world, 3000).samples;
    EXPECT_LT(largest_error(lit.transfer(samples, light, 0).weights, samples, kSide), .001) << divisions;
  }
  Mesh inside_out = ball(2);
  for (auto& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
  for (Vec3f& normal : inside_out.normals) normal = -normal;
  const LitWorld lit(world_of_mesh(inside_out));
  std::vector<SurfacePoint> points = points_over(lit);
  for (SurfacePoint& point : points) point.normal = -point.normal, point.geometric = -point.geometric;
  EXPECT_LT(largest_error(weights_at(lit, points, light), points, kSide), .001);
}

// Claim: facets keep their light. Source: their normals. Tolerance: as above. Fails if: points of meshes without
// vertex normals are lifted.
TEST(ShadowTerminator, OfFacetsIsTheirOwn) {
  const LitWorld lit(world_of_mesh(ball(2, false)));
  const std::vector<SurfacePoint> points = points_over(lit);
  EXPECT_LT(largest_error(weights_at(lit, points, unit_point(kSide)), points, kSide), .001);
}

// Claim: no light passes through a box that just holds a coarse ball, nor through a floor just below or across one, although
// the ball's smooth surface is beyond them. Source: geometry. Tolerance: none. Fails if: the way to the smooth
// surface may cross other surfaces.
TEST(ShadowTerminator, LetsNoLightThroughOtherSurfaces) {
  const auto beside_ball = [](const ShapeSource& source) {
    World world = world_of_mesh(ball(2));
    Shape shape;
    shape.source = source;
    Mesh other = make_mesh(shape).mesh;
    world.measures.push_back(measures_of(other));
    world.meshes.push_back(std::move(other));
    world.reports.resize(2);
    return LitWorld(std::move(world));
  };
  const LitWorld boxed = beside_ball(BoxShape{{-10.001, -10.001, -10.001}, {10.001, 10.001, 10.001}});
  const std::vector<SurfacePoint> points = points_over(boxed);
  for (const Vec3d& from : {Vec3d(100, 0, 0), Vec3d(11, 40, 1), Vec3d(-10, 0, 12), Vec3d(0, -60, 59)})
    for (const float weight : weights_at(boxed, points, unit_point(from))) ASSERT_EQ(weight, 0);
  for (const double height : {-10.001, -9.5, -8.})
    for (const Vec3d& from : {Vec3d(200, -11, 0), Vec3d(40, -15, 30), Vec3d(0, -50, 0)}) {
      const LitWorld on_floor = beside_ball(QuadShape{{-500, height, -500}, {0, 0, 1000}, {1000, 0, 0}});
      const std::vector<float> weights = weights_at(on_floor, points, unit_point(from));
      for (std::size_t i = 0; i < points.size(); ++i)
        if (double(points[i].position.y) > height) {
          ASSERT_EQ(weights[i], 0) << height;
        }
    }
}

}  // namespace
}  // namespace opaline
