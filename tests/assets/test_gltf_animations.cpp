// SPDX-License-Identifier: GPL-3.0-or-later
// Animations of glTF: values between keys, poses of nodes, skins and morph targets, and frames of an imported asset.
#include <cmath>

#include "asset_files/gltf_animation.h"
#include "asset_test.h"
#include "geometry/world.h"

namespace opaline::asset_test {
namespace {

/// Adds keys to the animation; the first call makes it.
void add_channel(Asset& asset, int node, const char* path, const std::vector<float>& times,
                 const std::vector<float>& values, const char* between = "LINEAR",
                 std::size_t animation = 0) {
  Json& all = asset.json["animations"];
  while (all.size() <= animation)
    all.push_back(
        {{"name", all.empty() ? "walk" : "run"}, {"channels", Json::array()}, {"samplers", Json::array()}});
  const char* type = std::string(path) == "rotation"  ? "VEC4"
                     : std::string(path) == "weights" ? "SCALAR"
                                                      : "VEC3";
  const int input = asset.accessor("SCALAR", kFloat, times), output = asset.accessor(type, kFloat, values);
  Json& one = asset.json["animations"][animation];
  one["channels"].push_back(
      {{"sampler", one["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  one["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", between}});
}

/// The node's transform at a time of the first animation.
Transform placed_at(const Asset& asset, double seconds, std::uint32_t node = 0) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  const std::shared_ptr<const GltfModel> gltf = load_gltf(folder.file("a.glb"));
  return GltfAnimation(*gltf, 0).at(seconds).placed.at(node);
}

Scene frame_of(const Asset& asset, const ScratchFolder& folder, int frame) {
  put_bytes(folder.file("a.glb"), asset.glb());
  return load_scene(folder.file("a.glb"), {}, frame);
}

/// Middle of the box around the scene's only shape, in metres.
Vec3d middle_at(const Asset& asset, int frame) {
  const ScratchFolder folder;
  const Scene scene = frame_of(asset, folder, frame);
  EXPECT_EQ(scene.shapes.size(), 1u);
  Vec3d low(1e300), high(-1e300);
  for (const Vec3d& p : make_mesh(scene.shapes.at(0)).mesh.positions) widen(low, high, p / 1000);
  return (low + high) * .5;
}

void expect_near(const Vec3d& got, const Vec3d& wanted, double tolerance = 1e-6) {
  EXPECT_LT(length(got - wanted), tolerance) << got.x << ' ' << got.y << ' ' << got.z;
}

// Claim: values between keys are linear, kept, or a Hermite spline with tangents by second; before the first key and after
// the last they stay. By hand: t^2 (3 - 2 t) = .15625 at a quarter, and 2 t (1 - t)^2 2 = .5625 from an out-tangent of 2.
// Source: glTF 2.0, appendix C. Fails if: tangents are taken by key, or the in- and out-tangents are exchanged.
TEST(GltfAnimations, ValuesBetweenKeys) {
  const auto x_at = [](const std::vector<float>& values, const char* between, double seconds) {
    Asset asset = cube_asset();
    add_channel(asset, 0, "translation", {1, 3}, values, between);
    return placed_at(asset, seconds).translation.x;
  };
  const std::vector<float> line{2, 0, 0, 6, 0, 0};
  for (const auto& [seconds, x] : {std::pair(0., 2.), {1., 2.}, {2.5, 5.}, {3., 6.}, {9., 6.}})
    EXPECT_NEAR(x_at(line, "LINEAR", seconds), x, 1e-12) << seconds;
  for (const auto& [seconds, x] : {std::pair(0., 2.), {2.9, 2.}, {3., 6.}})
    EXPECT_EQ(x_at(line, "STEP", seconds), x) << seconds;
  const std::vector<float> still{9, 0, 0, 0, 0, 0, 0, 0, 0, /**/ 0, 0, 0, 1, 0, 0, 9, 0, 0};
  EXPECT_NEAR(x_at(still, "CUBICSPLINE", 1.5), .15625, 1e-12);
  EXPECT_EQ(x_at(still, "CUBICSPLINE", 0), 0);
  EXPECT_EQ(x_at(still, "CUBICSPLINE", 9), 1);
  const std::vector<float> leaving{0, 0, 0, 0, 0, 0, 2, 0, 0, /**/ 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_NEAR(x_at(leaving, "CUBICSPLINE", 1.5), .5625, 1e-12);
}

// Claim: rotations take the shorter arc at constant speed, whatever the sign of their quaternions, and leave the node's own
// translation and scale. By hand: a third of 90 degrees. Fails if: the quaternions are blended (a third of the way is then
// 28.7 degrees), the longer arc is taken, or the rest of the node's transform is lost.
TEST(GltfAnimations, RotationsTakeTheShorterArc) {
  const float half = std::sqrt(.5f);
  for (const float sign : {1.f, -1.f}) {
    Asset asset = cube_asset();
    asset.json["nodes"][0].update({{"translation", {1, 2, 3}}, {"scale", {-2, 1, 1}}});
    add_channel(asset, 0, "rotation", {0, 3}, {0, 0, 0, 1, 0, 0, sign * half, sign * half});
    const Transform t = placed_at(asset, 1);
    expect_near(t.x, Vec3d(std::cos(M_PI / 6), std::sin(M_PI / 6), 0) * -2.);
    expect_near(t.translation, {1, 2, 3});
  }
}

// Claim: at 24 frames a second, frame 1 + 24 t shows the animation's time t: of a node beneath a moving one, of a skin whose
// joint moves, and of a morph target; a still image shows the first key. By hand. Fails if: the transform of the node is
// applied twice or not at all, a joint stays at rest, or the weights are those of the node.
TEST(GltfAnimations, FramesShowNodesSkinsAndTargets) {
  Asset child = cube_mesh();
  child.node({{"mesh", 0}, {"translation", {0, 5, 0}}});
  child.root(child.node({{"children", {0}}, {"scale", {2, 2, 2}}}));
  add_channel(child, 1, "translation", {0, 2}, {3, 0, 0, 7, 0, 0});
  expect_near(middle_at(child, 1), {3, 10, 0});
  expect_near(middle_at(child, 25), {5, 10, 0});
  expect_near(middle_at(child, 100), {7, 10, 0});

  Asset skinned;
  const int corners = skinned.accessor<float>("VEC3", kFloat, {0, 0, 0, 2, 0, 0, 0, 2, 0});
  const int joints = skinned.accessor<std::uint8_t>("VEC4", kUnsignedByte, std::vector<std::uint8_t>(12));
  const int weights =
      skinned.accessor<float>("VEC4", kFloat, std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  skinned.mesh({{"attributes", {{"POSITION", corners}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}});
  skinned.root(skinned.node({{"mesh", 0}, {"skin", 0}, {"translation", {500, 0, 0}}}));
  skinned.root(skinned.node({{"name", "joint"}}));
  skinned.json["skins"] = Json::array({{{"joints", {1}}}});
  add_channel(skinned, 1, "translation", {0, 1}, {0, 0, 0, 0, 0, 4});
  expect_near(middle_at(skinned, 1), {1, 1, 0});
  expect_near(middle_at(skinned, 13), {1, 1, 2});

  Asset morphed;
  const int positions = morphed.accessor<float>("VEC3", kFloat, {0, 0, 0, 2, 0, 0, 0, 2, 0});
  const int up = morphed.accessor<float>("VEC3", kFloat, {0, 0, 2, 0, 0, 2, 0, 0, 2});
  morphed.mesh({{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", up}}}}});
  morphed.root(morphed.node({{"mesh", 0}, {"weights", {.5}}}));
  add_channel(morphed, 0, "weights", {0, 1}, {0, 1});
  expect_near(middle_at(morphed, 1), {1, 1, 0});
  expect_near(middle_at(morphed, 25), {1, 1, 2});
}

// Claim: instances of a moving node move with it, each at its own place in the node's turned space; a part names one.
// By hand. Fails if: they stand still, all are the first, or an instance's transform is applied after the node's.
TEST(GltfAnimations, InstancesMoveWithTheirNode) {
  const float half = std::sqrt(.5f);
  Asset asset = cube_mesh();
  const int places = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 3, 0, 0});
  asset.root(asset.node(
      {{"mesh", 0},
       {"rotation", {0, 0, half, half}},  // a quarter turn about z
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}}));
  add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 0, 0, 8});
  const ScratchFolder folder;
  const Scene scene = frame_of(asset, folder, 13);  // halfway
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(scene.warnings.empty());
  const std::array<Vec3d, 2> middles{Vec3d(0, 0, 4), Vec3d(0, 3, 4)};
  for (std::size_t i = 0; i < middles.size(); ++i) {
    Vec3d low(1e300), high(-1e300);
    for (const Vec3d& p : make_mesh(scene.shapes[i]).mesh.positions) widen(low, high, p / 1000);
    expect_near((low + high) * .5, middles[i]);
  }
  Shape third = scene.shapes[1];
  std::get<MeshFile>(third.source).part = "0/0/0/2";
  EXPECT_THROW(make_mesh(third), Error);

  // Each has a mesh of its own: too many stand still, and a warning says so.
  const std::vector<float> many(3 * 1001);
  asset.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      asset.accessor<float>("VEC3", kFloat, many);
  const Scene crowd = frame_of(asset, folder, 13);
  EXPECT_EQ(crowd.shapes.size(), 1001u);
  ASSERT_EQ(crowd.warnings.size(), 1u);
  EXPECT_NE(crowd.warnings[0].find("its 1001 instances stand still"), std::string::npos) << crowd.warnings[0];
}

// Claim: a body that an animation mirrors still faces outwards. Fails if: its triangles keep their winding: the volume is
// below 0, and the mesh's check turns it with a warning.
TEST(GltfAnimations, MirroredBodiesFaceOutwards) {
  Asset asset = cube_asset();
  add_channel(asset, 0, "scale", {0, 1}, {-1, 1, 1, -2, 1, 1});
  const ScratchFolder folder;
  const Scene scene = frame_of(asset, folder, 25);
  const CheckedMesh cube = make_mesh(scene.shapes.at(0));
  EXPECT_NEAR(cube.mesh.positions.at(0).x * cube.mesh.positions.at(0).x, 4e6, 1);
  EXPECT_TRUE(cube.report.warnings.empty());
}

// Claim: the camera and the lights of moving nodes move, and the default camera sees all of the motion. Fails if: they stay,
// or the asset at rest is framed alone.
TEST(GltfAnimations, CamerasAndLightsMove) {
  Asset asset = cube_asset();
  asset.json["cameras"] =
      Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", .5}, {"znear", 1}}}}});
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "point"}}});
  asset.root(asset.node({{"camera", 0}, {"translation", {0, 0, 9}}}));
  asset.root(asset.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
  add_channel(asset, 1, "translation", {0, 1}, {0, 0, 9, 6, 0, 9});
  add_channel(asset, 2, "translation", {0, 1}, {0, 5, 0, 0, 7, 0});
  const ScratchFolder folder;
  const Scene middle = frame_of(asset, folder, 13);
  expect_near(middle.camera.position, {3000, 0, 9000}, 1e-3);
  expect_near(middle.camera.look_at, {3000, 0, 0}, 1e-3);
  expect_near(std::get<PointLight>(middle.lights.at(0).source).position, {0, 6000, 0}, 1e-3);
  Asset far = cube_asset();
  add_channel(far, 0, "translation", {0, 1}, {0, 0, 0, 0, 40, 0});
  const Scene framed = frame_of(far, folder, 1);
  EXPECT_NEAR(framed.camera.look_at.y, 20'000, 1);
  EXPECT_GT(length(framed.camera.position - framed.camera.look_at), 60'000);
}

// Claim: bodies that an animation hides by a scale of 0 are specks: a frame has them all, and moves none aside. Fails if: the
// frame is refused, for a mesh needs an area.
TEST(GltfAnimations, HiddenBodiesAreSpecks) {
  Asset asset = cube_asset();
  add_channel(asset, 0, "scale", {0, 1}, {0, 0, 0, 2, 2, 2});
  const ScratchFolder folder;
  const Scene scene = frame_of(asset, folder, 1);
  EXPECT_NEAR(surface_area(make_mesh(scene.shapes.at(0)).mesh), 24e6 * 4e-6, 1e-3);
  EXPECT_EQ(frame_of(asset, folder, 25).shapes.size(), 1u);
}

// Claim: morph targets of a skinned mesh play, too, where no joint moves. By hand. Fails if: joints alone are asked for.
TEST(GltfAnimations, FacesOfSkinnedMeshesMove) {
  Asset asset;
  const int corners = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 2, 0, 0, 0, 2, 0});
  const int up = asset.accessor<float>("VEC3", kFloat, {0, 0, 2, 0, 0, 2, 0, 0, 2});
  const int joints = asset.accessor<std::uint8_t>("VEC4", kUnsignedByte, std::vector<std::uint8_t>(12));
  const int weights =
      asset.accessor<float>("VEC4", kFloat, std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  asset.mesh({{"attributes", {{"POSITION", corners}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
              {"targets", {{{"POSITION", up}}}}});
  asset.root(asset.node({{"mesh", 0}, {"skin", 0}}));
  asset.root(asset.node({{"name", "joint"}}));
  asset.json["skins"] = Json::array({{{"joints", {1}}}});
  add_channel(asset, 0, "weights", {0, 1}, {0, 1});
  expect_near(middle_at(asset, 25), {1, 1, 2});
}

// Claim: --size is that of the asset at its start, not of its path. By hand: a cube of 2 m that moves by 40 m. Fails if: the
// box around the motion is scaled.
TEST(GltfAnimations, SizeIsOfThePose) {
  Asset asset = cube_asset();
  add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 0, 40, 0});
  EXPECT_NEAR(imported(asset).defaults.extent, 2, 1e-6);
}

// Claim: an animation that cannot be read leaves the asset at rest with a warning that names the record; the next one is
// used. One without a node is none. Fails if: the asset is refused, or stands still without a word.
TEST(GltfAnimations, BrokenOnesAreWarnings) {
  const auto warning = [](const std::function<void(Asset&)>& spoil) {
    Asset asset = cube_asset();
    add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
    spoil(asset);
    EXPECT_EQ(error_of(asset.glb(), "a.glb"), "");
    std::string text;
    for (const std::string& line : imported(asset).warnings) text += line;
    return text;
  };
  const auto has_text = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  EXPECT_EQ(warning([](Asset&) {}), "");
  has_text(warning([](Asset& a) { a.json["animations"][0]["channels"][0] = Json::object(); }),
           "animation 'walk': ignored, it cannot be read: ");
  has_text(warning([](Asset& a) { a.json["animations"][0]["channels"][0]["sampler"] = 5; }),
           "channels[0].sampler refers to nothing");
  has_text(warning([](Asset& a) { a.json["animations"][0]["samplers"][0]["interpolation"] = "SMOOTH"; }),
           "interpolation is unknown (expected LINEAR, STEP or CUBICSPLINE, got \"SMOOTH\")");
  has_text(warning([](Asset& a) { a.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; }),
           "has the wrong number of values for its keys (expected 18 numbers, got 6)");
  has_text(warning([](Asset& a) {
             a.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
           }),
           "nodes[0] has a matrix and cannot be animated");
  has_text(warning([](Asset& a) {
             a.json["animations"][0]["samplers"][0]["input"] = a.accessor<float>("SCALAR", kFloat, {1, 0});
           }),
           "element 1 is not a time (expected finite seconds, in ascending order");
  has_text(warning([](Asset& a) {
             a.json["animations"][0]["channels"][0]["target"]["node"] = 7;
             add_channel(a, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "LINEAR", 1);
           }),
           "target.node refers to nothing");
  EXPECT_EQ(warning([](Asset& a) { a.json["animations"][0]["channels"][0]["target"].erase("node"); }), "");
  has_text(warning([](Asset& a) { a.json["animations"][0] = 5; }), "animation '0': ignored");
  Asset second = cube_asset();
  add_channel(second, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  add_channel(second, 0, "translation", {0, 1}, {0, 0, 0, 0, 8, 0}, "LINEAR", 1);
  second.json["animations"][0]["channels"][0]["sampler"] = 5;
  expect_near(middle_at(second, 13), {0, 4, 0});
}

// Claim: an asset is imported with the animation of a name or number; others are listed. One that is not there, or moves
// nothing, is an error, as is any in a format without animations. Fails if: the first one moves the scene.
TEST(GltfAnimations, ImportsTakeTheChosenOne) {
  Asset asset = cube_asset();
  add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 0, 8, 0}, "LINEAR", 1);
  asset.json["animations"].push_back(
      {{"name", "rest"}, {"channels", Json::array()}, {"samplers", Json::array()}});
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  const auto import = [&](const std::string& animation, const char* file = "a.glb") {
    return import_asset(folder.file(file), file, {}, animation);
  };
  for (const char* run : {"run", "1"}) {
    const ImportedAsset chosen = import(run);
    EXPECT_TRUE(has(chosen.translated, "animation 'run' -> frames 1 to 25"));
    EXPECT_TRUE(has(chosen.not_carried, "animation 'walk': not imported"));
    const Scene scene = parse_scene(chosen.text, folder.file("s.json"), {}, 13);
    double top = -1e300;
    for (const Vec3d& p : make_mesh(scene.shapes.at(0)).mesh.positions) top = std::max(top, p.y);
    EXPECT_NEAR(top, 5000, 1e-3);
  }
  const auto mistake = [&](const std::string& animation, const char* file = "a.glb") -> std::string {
    try {
      import(animation, file);
    } catch (const Error& failure) {
      return failure.what();
    }
    return {};
  };
  EXPECT_NE(mistake("rum").find("a.glb: has no such animation (did you mean 'run'?)"), std::string::npos);
  EXPECT_NE(mistake("rest").find("moves nothing"), std::string::npos);
  put_bytes(folder.file("b.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_NE(mistake("run", "b.off").find("b.off: has no animations"), std::string::npos);
}

// Claim: a scene's "animation_time" and "animation" choose a pose by name or index; the file and the mistake are named.
// Fails if: the first animation is taken, or a mesh without animations is rendered as it is.
TEST(GltfAnimations, ScenesChooseThePose) {
  Asset asset = cube_asset();
  add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  add_channel(asset, 0, "translation", {0, 1}, {0, 0, 0, 0, 8, 0}, "LINEAR", 1);
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  const auto scene = [&](const std::string& keys) {
    return parse_scene(R"({"shapes": [{"file": "a.glb", "part": "0/0", )" + keys + "}]}",
                       folder.file("s.json"));
  };
  const auto top_of = [&](const std::string& keys) {
    double top = -1e300;
    for (const Vec3d& p : make_mesh(scene(keys).shapes.at(0)).mesh.positions) top = std::max(top, p.y);
    return top;
  };
  EXPECT_NEAR(top_of(R"("animation_time": 0.5)"), 1, 1e-6);
  for (const char* run : {R"("run")", R"("1")"})
    EXPECT_NEAR(top_of(R"("animation_time": 0.5, "animation": )" + std::string(run)), 5, 1e-6);
  const auto mistake = [&](const std::string& keys) -> std::string {
    try {
      make_mesh(scene(keys).shapes.at(0));
    } catch (const Error& failure) {
      return failure.what();
    }
    return {};
  };
  const auto has_text = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has_text(mistake(R"("animation_time": 0, "animation": "rum")"),
           "a.glb: has no such animation (did you mean 'run'?)");
  has_text(mistake(R"("animation_time": 0, "fit_size": 5)"), "cannot be combined with 'fit_size'");
  has_text(mistake(R"("animation_time": "soon")"), "animation_time");
  asset.root(asset.node({{"mesh", 0}}));
  put_bytes(folder.file("a.glb"), asset.glb());
  has_text(mistake(R"("animation_time": 0)"), "requires a part at a node");
  put_bytes(folder.file("b.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  try {
    make_mesh(parse_scene(R"({"shapes": [{"file": "b.off", "animation_time": 0}]})", folder.file("s.json"))
                  .shapes.at(0));
    FAIL();
  } catch (const Error& failure) {
    has_text(failure.what(), "b.off: the format has no animations");
  }
}

}  // namespace
}  // namespace opaline::asset_test
