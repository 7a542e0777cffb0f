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

}  // namespace
}  // namespace opaline
