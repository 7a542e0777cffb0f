// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds that floats cannot carry are refused by name before a ray structure or samples are made of them.
#include "geometry/ray_scene.h"
#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

Shape builtin(const std::string& name, ShapeSource source) {
  Shape shape;
  shape.name = name;
  shape.source = std::move(source);
  return shape;
}

/// what() of the Error{bad_input} that making the world throws; "" if its rays can be traced.
std::string world_error(std::vector<Shape> shapes) {
  Scene scene;
  scene.shapes = std::move(shapes);
  try {
    const RayScene rays(make_world(scene));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    return error.what();
  }
  return {};
}

bool holds(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

// Claim: a shape that is less than 2^-16 as large as it is far from the middle of the scene is refused by its
// name, with the size that would do. Fails if: check_precision is left out (the program before it: Embree's
// assertion, or endless division of triangles whose corners are one point in floats).
TEST(WorldPrecision, SmallShapesFarFromTheMiddle) {
  const SphereShape ball{{}, 10};
  const auto floor_at = [](double y) { return QuadShape{{-50, y, -50}, {0, 0, 100}, {100, 0, 0}}; };
  EXPECT_EQ(world_error({builtin("ball", ball), builtin("floor", floor_at(-1e6))}), "");
  const std::string error = world_error({builtin("ball", ball), builtin("floor", floor_at(-1e16))});
  EXPECT_TRUE(holds(error, "shape 'ball'")) << error;
  EXPECT_TRUE(holds(error, "at least 6.872e+10 mm")) << error;
  EXPECT_TRUE(holds(error, "got 20 mm")) << error;
  EXPECT_TRUE(
      holds(world_error({builtin("a", ball), builtin("b", SphereShape{{1e15, 0, 0}, 10})}), "shape 'a'"));
}

// Claim: in the middle, a shape may be 2^30 times smaller than the scene, not more. Fails if: areas and
// kernels of such a shape are computed in the unit of the scene, where they leave the floats.
TEST(WorldPrecision, SmallShapesInTheMiddle) {
  const auto floor_of = [](double side) {
    return QuadShape{{-side / 2, -1, -side / 2}, {0, 0, side}, {side, 0, 0}};
  };
  const SphereShape ball{{}, 1};
  EXPECT_EQ(world_error({builtin("ball", ball), builtin("floor", floor_of(1e9))}), "");
  EXPECT_TRUE(holds(world_error({builtin("ball", ball), builtin("floor", floor_of(1e10))}),
                    "shape 'ball': is too small for the scene (expected at least 13.17 mm"));
}

// Claim: triangles that collapse where their corners become floats are refused by the name of their mesh: a
// cube of side 1 with a face that reaches 1e9 away, and a turned sheet of 1e9 by 1. Such a face at 1e6, as
// dirty scans have it, is not: it changes the area by less than a tenth. Fails if: only the extent of a mesh
// is looked at.
TEST(WorldPrecision, ThinTriangles) {
  Soup soup = cube(.5);
  soup.positions.push_back({1e9, 7e8, 3e8});
  soup.triangles.push_back({0, 1, 8});
  const ScratchFolder folder;
  put_bytes(folder.file("stray.obj"), obj(soup));
  const std::vector<Shape> stray{file_shape(folder.file("stray.obj")), builtin("torus", TorusShape{{}, 2, 1}),
                                 builtin("ball", SphereShape{{}, 1})};
  EXPECT_TRUE(holds(world_error(stray), "stray.obj: is too thin or too fine for its extent"));
  EXPECT_TRUE(holds(world_error({stray[0]}), "stray.obj: is too thin or too fine for its extent"));

  Shape sheet = builtin("sheet", QuadShape{{-5e8, 0, 0}, {1e9, 0, 0}, {0, 0, 1}});
  const double s = std::sqrt(.5);
  sheet.to_world = {{s, s, 0}, {-s, s, 0}, {0, 0, 1}, {}};
  EXPECT_EQ(world_error({sheet}), "");
  sheet.to_world = {{s, .5, .5}, {-s, .5, .5}, {0, -s, s}, {}};
  EXPECT_TRUE(holds(world_error({sheet}), "shape 'sheet': is too thin"));

  soup.positions.back() = {1e6, 7e5, 3e5};
  put_bytes(folder.file("dirty.obj"), obj(soup));
  EXPECT_EQ(world_error({file_shape(folder.file("dirty.obj"))}), "");
}

// Claim: the world's unit is the power of 1024 for which its diagonal is 1 to 1024, and its points come back.
TEST(WorldPrecision, Unit) {
  for (const double k : {1e-18, 1e-6, 1., 511., 1e3, 1e9, 1e17}) {
    Scene scene;
    scene.shapes = {builtin("ball", SphereShape{{2 * k, 0, k}, k})};
    const World world = make_world(scene);
    EXPECT_GE(world.diagonal, 1);
    EXPECT_LT(world.diagonal, 1024);
    EXPECT_DOUBLE_EQ(world.diagonal * world.unit, 2 * std::sqrt(3) * k);
    const Vec3d p{1.5 * k, k, -k};
    EXPECT_LE(length(out_of_world(world, into_world(world, p)) - p), 1e-15 * k);
  }
}

}  // namespace
}  // namespace opaline
