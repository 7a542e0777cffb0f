// SPDX-License-Identifier: GPL-3.0-or-later
// Built-in shapes: true areas, closed, normals exact.
#include <cmath>
#include <limits>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

CheckedMesh made(const ShapeSource& source, NormalMode normals = NormalMode::smooth) {
  Shape shape;
  shape.name = "it";
  shape.source = source;
  shape.normals = normals;
  return make_mesh(shape);
}

struct Line {
  const char* name;
  ShapeSource source;
  double area, volume;
};

// Claim: area within 1e-3 of the true one (make_mesh.h), volume too; closed; nothing to warn of. Source:
// formulas of the solids. Tolerance: 1e-3 relative. Fails if: the sphere is cut one level less than 4 times,
// the torus into fewer than about 60 by 40, a face is wound inward.
TEST(BuiltinShapes, AreaAndVolume) {
  const double pi2 = M_PI * M_PI;
  const std::vector<Line> lines{
      {"sphere", SphereShape{{1, 2, 3}, 7}, 4 * M_PI * 49, 4 / 3.0 * M_PI * 343},
      {"box", BoxShape{{0.1, 0.2, 0.3}, {1.3, 2.5, 4.7}}, 2 * (1.2 * 2.3 + 2.3 * 4.4 + 4.4 * 1.2),
       1.2 * 2.3 * 4.4},
      {"slab", SlabShape{{0.1, 0.2, 0.3}, 20, 30, 0.7}, 2 * (600 + 0.7 * 50), 600 * 0.7},
      {"torus", TorusShape{{1, 2, 3}, 5, 2}, 4 * pi2 * 10, 2 * pi2 * 5 * 4}};
  for (const Line& line : lines) {
    for (const NormalMode mode : {NormalMode::smooth, NormalMode::faceted}) {
      const CheckedMesh shape = made(line.source, mode);
      EXPECT_NEAR(surface_area(shape.mesh) / line.area, 1, 1e-3) << line.name;
      EXPECT_NEAR(signed_volume(shape.mesh) / line.volume, 1, 1e-3) << line.name;
      EXPECT_EQ(shape.report.open_edges + shape.report.non_manifold_edges + shape.report.flipped, 0u)
          << line.name;
      EXPECT_TRUE(shape.report.warnings.empty()) << line.name;
    }
  }
  EXPECT_DOUBLE_EQ(surface_area(made(QuadShape{{0, 0, 0}, {3, 0, 0}, {1, 0, -2}}).mesh), 6);
}

// Claim: vertices of sphere and torus lie on the surface, normals are its own; a box's are flat. Source:
// geometry. Tolerance: rounding in double, in float. Fails if: middles of edges are not pushed out to the
// sphere, or a box's corners are shared.
TEST(BuiltinShapes, VerticesAndNormalsAreExact) {
  const Vec3d center{1, 2, 3};
  const Mesh ball = made(SphereShape{center, 7}).mesh, ring = made(TorusShape{center, 5, 2}).mesh;
  for (std::size_t v = 0; v < ball.positions.size(); ++v) {
    const Vec3d d = ball.positions[v] - center;
    ASSERT_NEAR(length(d), 7, 1e-14 * 10);
    ASSERT_NEAR(length(Vec3d(ball.normals[v]) - d / 7.0), 0, 1e-6);
  }
  for (std::size_t v = 0; v < ring.positions.size(); ++v) {
    const Vec3d d = ring.positions[v] - center;
    const Vec3d tube = d - normalized(Vec3d(d.x, 0, d.z)) * 5.0;
    ASSERT_NEAR(length(tube), 2, 1e-14 * 10);
    ASSERT_NEAR(length(Vec3d(ring.normals[v]) - tube / 2.0), 0, 1e-6);
  }
  const Mesh box = made(BoxShape{}).mesh;
  ASSERT_EQ(box.positions.size(), 24u);
  for (std::size_t v = 0; v < 24; ++v) EXPECT_EQ(dot(box.normals[v], Vec3f(box.positions[v])), 1);
}

// Claim: a quad faces along u x v, and is open without complaint unless it is translucent. Source: scene.h.
// Tolerance: none. Fails if: u and v are exchanged, or the warning is given to every quad.
TEST(BuiltinShapes, QuadFacesUCrossV) {
  const CheckedMesh quad = made(QuadShape{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}});
  for (const Vec3f& n : quad.mesh.normals) EXPECT_EQ(n, Vec3f(0, 1, 0));
  EXPECT_EQ(quad.report.open_edges, 4u);
  EXPECT_TRUE(quad.report.warnings.empty());
  Shape translucent;
  translucent.name = "leaf";
  translucent.source = QuadShape{};
  translucent.medium = 0;
  EXPECT_TRUE(warns(make_mesh(translucent).report, "shape 'leaf': open mesh: 4 boundary edges"));
}

// Claim: sizes that are zero, negative or not finite are errors that name the shape. Source: make_mesh.h.
// Tolerance: none. Fails if: a size is not checked.
TEST(BuiltinShapes, BadSizesAreErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<ShapeSource> bad{SphereShape{{}, 0},
                                     SphereShape{{}, nan},
                                     BoxShape{{0, 0, 0}, {1, 0, 1}},
                                     BoxShape{{0, 0, 0}, {1, 1, -1}},
                                     SlabShape{{}, 1, 1, -1},
                                     TorusShape{{}, 1, 0},
                                     QuadShape{{}, {0, 0, 0}, {1, 0, 0}},
                                     QuadShape{{}, {1, 0, 0}, {2, 0, 0}},
                                     SphereShape{{nan, 0, 0}, 1},
                                     SphereShape{{}, 1e19}};
  for (const ShapeSource& source : bad) {
    try {
      made(source);
      ADD_FAILURE() << "taken: kind " << source.index();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("shape 'it'", 0), 0u) << error.what();
      EXPECT_EQ(error.kind, ErrorKind::bad_input);
    }
  }
}

}  // namespace
}  // namespace opaline
