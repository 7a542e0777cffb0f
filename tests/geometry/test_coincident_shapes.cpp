// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that lie twice in one place are reported; shapes that only touch or enclose each other are not.
#include "geometry/coincident_shapes.h"
#include "geometry/world.h"
#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

Shape named(const std::string& name, ShapeSource source, const Vec3d& place = {}) {
  Shape shape;
  shape.name = name;
  shape.source = std::move(source);
  shape.to_world.translation = place;
  return shape;
}

std::vector<std::string> warnings_of(const std::vector<Shape>& shapes) {
  Scene scene;
  scene.shapes = shapes;
  return warnings_of_coincident_shapes(scene, make_world(scene));
}

// Claim: one surface twice in one place is a warning that names both shapes, however they came there. Source: coincident_shapes.h.
// Tolerance: none. Fails if: only shapes of one file, or of one transform, are compared.
TEST(CoincidentShapes, AreNamed) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"), obj(sphere(3)));
  put_bytes(folder.file("b.obj"), obj(flipped(sphere(3))));
  MeshFile a, b;
  a.path = folder.file("a.obj");
  b.path = folder.file("b.obj");
  const std::vector<std::pair<Shape, Shape>> pairs{
      {named("left", SphereShape{{}, 10}), named("right", SphereShape{{}, 10})},
      {named("left", SphereShape{{5, 0, 0}, 10}), named("right", SphereShape{{}, 10}, {5, 0, 0})},
      {named("left", a), named("right", a)},
      {named("left", a), named("right", b)},
      {named("left", BoxShape{{0, 0, 0}, {1, 2, 3}}), named("right", SlabShape{{.5, 1, 1.5}, 1, 3, 2})}};
  for (const auto& [left, right] : pairs) {
    const std::vector<std::string> warnings =
        warnings_of({named("far", SphereShape{{90, 0, 0}, 1}), left, right});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].find("the shapes 'left' and 'right' have coincident surfaces"), 0u) << warnings[0];
  }
  std::vector<Shape> many;
  for (int i = 0; i < 7; ++i) many.push_back(named("s" + std::to_string(i), SphereShape{{}, 10, 4}));
  const std::vector<std::string> warnings = warnings_of(many);
  ASSERT_EQ(warnings.size(), 4u);
  EXPECT_EQ(warnings[3], "3 more shapes coincide with another shape");
}

// Claim: shapes that overlap, touch, enclose each other or have equal bounds alone are no doubles. Source: coincident_shapes.h.
// Fails if: bounds decide.
TEST(CoincidentShapes, NestedAndTouchingShapesAreNone) {
  const Shape ball = named("ball", SphereShape{{}, 10});
  for (const Shape& other :
       {named("b", SphereShape{{}, 9.99}), named("b", SphereShape{{.1, 0, 0}, 10}),
        named("b", SphereShape{{20, 0, 0}, 10}), named("b", BoxShape{{-10, -10, -10}, {10, 10, 10}}),
        named("b", BoxShape{{-10, -20, -10}, {10, -10, 10}})})
    EXPECT_TRUE(warnings_of({ball, other}).empty());
  EXPECT_TRUE(
      warnings_of({named("a", BoxShape{{0, 0, 0}, {1, 1, 1}}), named("b", BoxShape{{1, 0, 0}, {2, 1, 1}})})
          .empty());
  EXPECT_TRUE(warnings_of({}).empty());
}

// Claim: overlapping faces in one plane are a warning where the camera sees both: side faces flush, a quad on a wall, a floor from
// below; tessellated ones, too. Hidden faces (a cube on a block or a floor), neighbours, faces of one colour and whole doubles
// are none. Source: coincident_shapes.h. Tolerance: none. Fails if: bounds or the corners of triangles decide.
TEST(CoincidentShapes, VisibleCoplanarFacesAreNamed) {
  const auto count = [](Shape left, Shape right, const Vec3d& camera) {
    right.reflectance = {.8, .2, .2};
    Scene scene;
    scene.shapes = {named("far", SphereShape{{90, 0, 0}, 1}), std::move(left), std::move(right)};
    scene.camera.position = camera;
    const std::vector<std::string> warnings = warnings_of_coincident_faces(scene, make_world(scene));
    for (const std::string& text : warnings)
      EXPECT_EQ(text.find("the shapes 'left' and 'right' have coincident faces"), 0u) << text;
    return warnings.size();
  };
  const Vec3d front{3, 4, 50}, below{3, -40, 50};
  const Shape block = named("left", BoxShape{{-9, -9, -9}, {9, 0, 9}}),
              floor = named("left", QuadShape{{-9, 0, -9}, {0, 0, 18}, {18, 0, 0}}),
              room = named("left", BoxShape{{-60, -60, -60}, {60, 60, 60}});
  const auto cube = [](double y, double z) {
    return named("right", BoxShape{{-3, y, z - 6}, {3, y + 6, z}});
  };
  EXPECT_EQ(count(block, cube(-2, 9), front), 1u);
  EXPECT_EQ(count(block, cube(-2, 9 + 1e-7), front), 1u);
  EXPECT_EQ(count(block, cube(-2, 9), {3, 4, -50}), 0u);
  EXPECT_EQ(count(block, cube(-2, 8.99), front), 0u);
  EXPECT_EQ(count(block, cube(0, 9), front), 0u);
  EXPECT_EQ(count(floor, cube(0, 9), front), 0u);
  EXPECT_EQ(count(floor, cube(0, 9), below), 1u);
  EXPECT_EQ(count(block, named("right", BoxShape{{9, -9, -9}, {12, 0, 9}}), front), 0u);
  EXPECT_EQ(count(room, named("right", QuadShape{{-5, 0, -60}, {20, 0, 0}, {0, 3, 0}}), front), 1u);
  EXPECT_EQ(count(room, cube(-60, 9), front), 0u);
  EXPECT_EQ(count(block, named("right", BoxShape{{-9, -9, -9}, {9, 0, 9}}), front), 0u);
  Scene grey;
  grey.shapes = {block, cube(-2, 9)};
  grey.camera.position = front;
  EXPECT_TRUE(warnings_of_coincident_faces(grey, make_world(grey)).empty());
}

// Claim: of two grids of many triangles in one plane, shifted by a third of a triangle, the overlap of one row and column is found, a
// touching edge is not. Source: coplanar_faces.h. Fails if: the division of space loses triangles.
TEST(CoincidentShapes, TessellatedFaces) {
  const ScratchFolder folder;
  constexpr int kSide = 60;
  std::string text;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j) text += "v " + std::to_string(i) + " 0 " + std::to_string(j) + '\n';
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const auto at = [&](int x, int z) { return ' ' + std::to_string(1 + (i + x) * (kSide + 1) + j + z); };
      text += "f" + at(0, 0) + at(0, 1) + at(1, 1) + "\nf" + at(0, 0) + at(1, 1) + at(1, 0) + '\n';
    }
  put_bytes(folder.file("grid.obj"), text);
  MeshFile grid;
  grid.path = folder.file("grid.obj");
  for (const auto& [shift, expected] : {std::pair{kSide - 1 / 3., 1u}, std::pair{double(kSide), 0u}}) {
    Scene scene;
    scene.shapes = {named("a", grid), named("b", grid, {shift, 0, shift})};
    scene.shapes[1].reflectance = {.8, .2, .2};
    EXPECT_EQ(warnings_of_coincident_faces(scene, make_world(scene)).size(), expected) << shift;
  }
}

}  // namespace
}  // namespace opaline
