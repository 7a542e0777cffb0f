// SPDX-License-Identifier: GPL-3.0-or-later
// What is found wrong with a shape after its scene was read is said where the scene has the shape.
#include "geometry/world.h"
#include "input/load_scene.h"
#include "mesh_test.h"

namespace opaline {
namespace {

/// What make_world says of a scene text in that folder.
std::string world_error(const ScratchFolder& folder, const std::string& text,
                        const std::vector<std::string>& overrides = {}) {
  try {
    make_world(parse_scene(text, folder.file("scene.json"), overrides));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    return error.what();
  }
  ADD_FAILURE() << "no error for " << text;
  return {};
}

// Claim: a mesh that is missing, broken or too far out, and a built-in shape too far out, are named with
// file, line and column of their source in the scene; a missing one with the nearest name in its folder, or with the script that fetches it; a
// value from the command line with its --set. Source: world.h; lines and columns counted by hand. Fails if:
// told_at is left out of update_world, or a place counts from the shape instead of its source.
TEST(ShapePlaces, ErrorsNameLineAndColumnOfTheScene) {
  const ScratchFolder folder;
  put_bytes(folder.file("bunny.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  const std::string scene = folder.file("scene.json"), bunny = folder.file("bunny.obj");
  EXPECT_EQ(world_error(folder, "{\"shapes\": [\n  {\"file\": \"buny.obj\"}]}"),
            scene + ":2:12: " + folder.file("buny.obj") + ": no such mesh file (did you mean '" +
                folder.file("bunny.obj") + "'?)");
  EXPECT_EQ(
      world_error(folder, "{\"shapes\": [\n  {\"sphere\": {\"radius\": 1}},\n{\"file\": \"bunny.obj\"}]}"),
      scene + ":3:10: " + bunny + ":4: vertex index out of range in a face (expected at most 3, got 9)");
  EXPECT_EQ(world_error(folder, R"({"shapes": [{"name": "ball", "sphere": {"radius": 1e10},
    "transform": [{"scale": 1e10}]}]})"),
            scene +
                ":1:40: shape 'ball': a vertex is too far from the origin after the transform (expected "
                "coordinates "
                "below 1e18)");
  EXPECT_EQ(world_error(folder, "{\"shapes\": [{\"file\": \"a.obj\"}]}", {"shapes.0.file=b.obj"}),
            "--set shapes.0.file=b.obj: " + folder.file("b.obj") + ": no such mesh file");
  put_bytes(folder.file("dig2.obj"), "");  // its extension alone makes it no similar name
  EXPECT_EQ(world_error(folder, R"({"shapes": [{"file": "dog.obj"}]})"),
            scene + ":1:22: " + folder.file("dog.obj") + ": no such mesh file");
  put_bytes(folder.file("gallery"), "fetches them");
  EXPECT_EQ(world_error(folder, R"({"shapes": [{"file": "assets/a.obj"}]})"),
            scene + ":1:22: " + folder.file("assets/a.obj") + ": no such mesh file (" +
                folder.file("gallery") + " downloads the assets of these scenes)");
}

// Claim: where a record is written is no part of it: two texts of one scene are equal, and edits that move
// lines are none. Source: source_place.h. Fails if: SourcePlace compares its members.
TEST(ShapePlaces, AreNoPartOfTheScene) {
  const std::string text = R"({"shapes": [{"sphere": {"radius": 1}}]})";
  EXPECT_EQ(parse_scene(text, "a.json"), parse_scene("\n\n" + text, "a.json"));
}

// Claim: materials that an OBJ file names are said to be left out, once a file and with the line; a file
// without any says nothing. Source: read_mesh.h. Fails if: mtllib is passed over in silence.
TEST(ShapePlaces, MaterialsOfAMeshAreSaidToBeLeftOut) {
  const ScratchFolder folder;
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  put_bytes(folder.file("plain.obj"), faces);
  put_bytes(folder.file("painted.obj"), "# painted\nmtllib painted.mtl\n" + faces + "usemtl red\n");
  const auto warnings = [&](const char* file) {
    return make_world(parse_scene("{\"shapes\": [{\"file\": \"" + std::string(file) + "\"}]}",
                                  folder.file("scene.json")))
        .reports[0]
        .warnings;
  };
  EXPECT_TRUE(warnings("plain.obj").empty());
  ASSERT_EQ(warnings("painted.obj").size(), 1u);
  EXPECT_TRUE(warnings("painted.obj")[0].starts_with(folder.file("painted.obj") + ":2: materials"))
      << warnings("painted.obj")[0];
}

}  // namespace
}  // namespace opaline
