// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "asset_test.h"
#include "geometry/world.h"

namespace opaline::asset_test {
namespace {

const Vec3d kPoint{.3, -.2, .7};

/// Where the scene's shape has the point of its mesh, in metres.
Vec3d placed(const Scene& scene, std::size_t shape) {
  return transform_point(scene.shapes.at(shape).to_world, kPoint) / 1000;
}

void expect_near(const Vec3d& a, const Vec3d& b) {
  EXPECT_NEAR(length(a - b), 0, 1e-12) << a.x << ' ' << a.y << ' ' << a.z;
}

// Claim: a node is placed by its translation, rotation and scale, or by its matrix, behind its parents'; metres become
// millimetres. Source: glTF 2.0, section 3.5.3: T * R * S, quaternions are x, y, z, w, matrices are stored by columns.
// Fails if the order of the factors, of the quaternion or of the matrix changes.
TEST(GltfScenes, NodesArePlacedByAllTheirParents) {
  Asset asset = cube_mesh();
  const double h = std::sqrt(.5);
  asset.node(
      {{"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"scale", {2, 3, 4}}, {"children", {1}}});
  asset.node({{"matrix", {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1}}, {"mesh", 0}, {"name", "child"}});
  asset.root(0);
  const Scene scene = scene_of(asset.glb(), "a.glb");
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.shapes[0].name, "child");
  EXPECT_EQ(scene.mm_per_unit, 1000);
  const Vec3d local{kPoint.z + 5, kPoint.y + 6, -kPoint.x + 7};  // the matrix
  const Vec3d scaled{2 * local.x, 3 * local.y, 4 * local.z};     // S
  expect_near(placed(scene, 0),
              {-scaled.y + 1, scaled.x + 2, scaled.z + 3});  // R: a quarter turn about z, then T
}

// Claim: a mesh at two nodes is two shapes, one of which may be mirrored and still faces outward; equal names get
// numbers. Source: glTF 2.0, section 3.7.4. Fails if a negative determinant does not turn triangles.
TEST(GltfScenes, InstancesMayBeMirrored) {
  Asset asset = cube_mesh();
  asset.root(asset.node({{"name", "a"}, {"mesh", 0}}));
  asset.root(asset.node({{"name", "a"}, {"mesh", 0}, {"scale", {-1, 1, 1}}, {"translation", {5, 0, 0}}}));
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  const Scene scene = load_scene(folder.file("a.glb"));
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[1].name, "a-2");
  const CheckedMesh mirrored = make_mesh(scene.shapes[1]);
  EXPECT_EQ(mirrored.report.flipped, 0u);
  const auto& [a, b, c] = mirrored.mesh.triangles[0];
  const std::vector<Vec3d>& p = mirrored.mesh.positions;
  const Vec3d outward = p[a] - Vec3d(5000, 0, 0);
  EXPECT_GT(dot(cross(p[b] - p[a], p[c] - p[a]), outward), 0);
  EXPECT_GT(dot(Vec3d(mirrored.mesh.normals[a]), outward), 0);
}

// Claim: the default scene is shown, or else the first, and what is left out is said; without scenes all nodes are
// shown. Fails if "scene" is not read.
TEST(GltfScenes, TheDefaultSceneIsShown) {
  Asset asset = cube_mesh();
  asset.node({{"name", "first"}, {"mesh", 0}});
  asset.node({{"name", "second"}, {"mesh", 0}});
  EXPECT_EQ(scene_of(asset.glb(), "a.glb").shapes.size(), 2u);
  asset.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(scene_of(asset.glb(), "a.glb").shapes.at(0).name, "first");
  asset.json["scene"] = 1;
  EXPECT_EQ(scene_of(asset.glb(), "a.glb").shapes.at(0).name, "second");
  EXPECT_TRUE(has(imported(asset).not_carried, "1 of its 2 scenes: uses scenes[1]"));
}

// Claim: an orthographic camera has the height of twice its ymag, in metres, and the shape of its picture; without a height it is
// said to be left out. Source: glTF 2.0, section 3.10.3. Fails if: xmag is the height.
TEST(GltfScenes, OrthographicCamerasHaveTheirHeight) {
  Asset asset = cube_asset();
  asset.json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 1}, {"zfar", 9}}}}};
  asset.root(asset.node({{"camera", 0}, {"translation", {0, 0, 6}}}));
  const Scene scene = scene_of(asset.glb(), "a.glb");
  EXPECT_EQ(scene.camera.orthographic_height, 4000);
  EXPECT_EQ(scene.film.resolution, (std::array<int, 2>{512, 256}));
  asset.json["cameras"][0]["orthographic"]["ymag"] = 0;
  EXPECT_TRUE(has(imported(asset).not_carried, "its height of 0 m"));
}

// Claim: a perspective camera looks along its node's -z, with its angle and the shape of its picture; further ones are
// said to be left out. Source: glTF 2.0, section 3.10. Fails if it looks along +z.
TEST(GltfScenes, CamerasLookAlongMinusZ) {
  Asset asset = cube_asset();
  asset.json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 1}, {"zfar", 9}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", .5}, {"aspectRatio", 2}, {"znear", .1}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", .7}, {"znear", .1}}}}};
  const double h = std::sqrt(.5);
  asset.root(asset.node({{"camera", 0}}));
  asset.root(
      asset.node({{"camera", 1}, {"translation", {10, 0, 0}}, {"rotation", {0, h, 0, h}}, {"name", "eye"}}));
  asset.root(asset.node({{"camera", 2}}));
  const Scene scene = scene_of(asset.glb(), "a.glb");
  expect_near(scene.camera.position / 1000, {10, 0, 0});
  expect_near(normalized(scene.camera.look_at - scene.camera.position), {-1, 0, 0});
  expect_near(scene.camera.up, {0, 1, 0});
  EXPECT_NEAR(scene.camera.field_of_view, .5 * 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(scene.film.resolution, (std::array<int, 2>{512, 256}));
  const std::vector<std::string> lines = imported(asset).not_carried;
  EXPECT_TRUE(has(lines, "cameras[0]: ignored, its height of 0 m or its node is invalid"));
  EXPECT_TRUE(has(lines, "cameras[2]: ignored, the scene already has one"));
}

// Claim: point, spot and directional lights are placed by their nodes, shine along -z, and a candela is 1e6 W/sr as a
// lux is 1 W/mm^2; the exposure shows white at the asset's centre as .8. Source: KHR_lights_punctual. Fails if one
// of the units changes.
TEST(GltfScenes, PunctualLightsKeepTheirRatios) {
  Asset asset = cube_asset();
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 50}, {"color", {1, .5, .25}}},
      {{"type", "spot"},
       {"intensity", 20},
       {"range", 3},
       {"spot", {{"outerConeAngle", .5}, {"innerConeAngle", .25}}}},
      {{"type", "directional"}, {"intensity", 2}, {"name", "sun"}}};
  for (int i = 0; i < 3; ++i)
    asset.root(asset.node({{"translation", {0, 5, 0}},
                           {"rotation", {-std::sqrt(.5), 0, 0, std::sqrt(.5)}},
                           {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}}));
  const Scene scene = scene_of(asset.glb(), "a.glb");
  ASSERT_EQ(scene.lights.size(), 3u);
  const auto& point = std::get<PointLight>(scene.lights[0].source);
  expect_near(point.position, {0, 5000, 0});
  expect_near(point.intensity / 1e6, {50, 25, 12.5});
  const auto& spot = std::get<SpotLight>(scene.lights[1].source);
  expect_near(spot.direction, {0, -1, 0});
  EXPECT_NEAR(spot.outer_angle, .5 * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(spot.inner_angle, .25 * 180 / std::numbers::pi, 1e-12);
  const auto& sun = std::get<DirectionalLight>(scene.lights[2].source);
  EXPECT_EQ(scene.lights[2].name, "sun");
  expect_near(sun.direction, {0, -1, 0});
  EXPECT_EQ(sun.irradiance, Rgb(2, 2, 2));
  const double point_lux = 50 * (.2126 + .7152 * .5 + .0722 * .25) / 25, spot_lux = 20 / 25.;
  EXPECT_NEAR(std::exp2(scene.film.exposure) * (point_lux + spot_lux + 2) / std::numbers::pi, .8, .01);
  EXPECT_TRUE(has(imported(asset).not_carried, "range 3 m"));
}

// Claim: a spot light whose light does not fade towards its rim, as Blender's exporter writes it, keeps its cone, and one
// that fades inside out is told and has the defaults. Source: KHR_lights_punctual asks for an inner angle less than the
// outer. Fails if: equal angles are refused (a cone of 45 degrees then).
TEST(GltfScenes, HardRimsKeepTheirCone) {
  for (const double inner : {.5, .6}) {
    Asset asset = cube_asset();
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 20}, {"spot", {{"outerConeAngle", .5}, {"innerConeAngle", inner}}}}};
    asset.root(asset.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
    const Scene scene = scene_of(asset.glb(), "a.glb");
    const auto& spot = std::get<SpotLight>(scene.lights.at(0).source);
    const double degrees = .5 * 180 / std::numbers::pi;
    EXPECT_NEAR(spot.outer_angle, inner > .5 ? 45 : degrees, 1e-12);
    EXPECT_NEAR(spot.inner_angle, inner > .5 ? 0 : degrees, .03);
    EXPECT_EQ(has(imported(asset).warnings, "cone angles"), inner > .5);
  }
}

// Claim: the color, intensity and range of a light outside of the schema's ranges are clamped with a warning. Source: the JSON
// schema of KHR_lights_punctual. Fails if one is taken as it stands, or refuses the whole asset.
TEST(GltfScenes, LightsOutOfRangeAreClampedWithAWarning) {
  Asset asset = cube_asset();
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 50}, {"color", {1.5, -1, .5}}, {"range", -1}},
      {{"type", "point"}, {"intensity", -3}}};
  for (const int light : {0, 1})
    asset.root(asset.node(
        {{"translation", {0, 5, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}}));
  const std::vector<std::string> warnings = imported(asset).warnings;
  for (const char* text : {"lights[0].color is out of range (expected 0 to 1, got [1.5,-1,0.5])",
                           "lights[0].range is out of range (expected above 0, got -1)",
                           "lights[1].intensity is out of range (expected at least 0, got -3)"})
    EXPECT_TRUE(has(warnings, text)) << text;
  const Scene scene = scene_of(asset.glb(), "a.glb");
  expect_near(std::get<PointLight>(scene.lights.at(0).source).intensity / 1e6, {50, 0, 25});
  expect_near(std::get<PointLight>(scene.lights.at(1).source).intensity, {0, 0, 0});
}

// Claim: lights as bright as real lamps make an EXR of floats, since halves end at 65504. Fails if the brightness of
// the file has no say in the pixels' type.
TEST(GltfScenes, BrightLightsMakeFloats) {
  for (const double candela : {10., 1e5}) {
    Asset asset = cube_asset();
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", candela}}};
    asset.root(
        asset.node({{"translation", {0, 5, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
    EXPECT_EQ(scene_of(asset.glb(), "a.glb").film.half, candela < 100);
  }
}

// Claim: without a camera the picture holds the asset, at three quarters, whatever its size and place, and without
// lights there are three around it. Fails if the distance does not follow from the radius.
TEST(GltfScenes, TheDefaultCameraHoldsTheAsset) {
  for (const double size : {1e-4, 1., 1e4}) {
    Asset asset = cube_mesh();
    asset.root(
        asset.node({{"mesh", 0}, {"scale", {size, 2 * size, size}}, {"translation", {7 * size, 0, -size}}}));
    const ScratchFolder folder;
    put_bytes(folder.file("a.glb"), asset.glb());
    const Scene scene = load_scene(folder.file("a.glb"));
    const Vec3d forward = normalized(scene.camera.look_at - scene.camera.position);
    EXPECT_LT(forward.x, -.3);
    EXPECT_LT(forward.y, -.2);
    EXPECT_LT(forward.z, -.3);
    double widest = 0;
    for (const Vec3d& p : make_mesh(scene.shapes[0]).mesh.positions) {
      const Vec3d d = p - scene.camera.position;
      widest = std::max(widest, std::acos(std::clamp(dot(normalized(d), forward), -1., 1.)));
    }
    const double half = scene.camera.field_of_view / 2 * std::numbers::pi / 180;
    EXPECT_LT(widest, half);
    EXPECT_GT(widest, .7 * half);
    ASSERT_EQ(scene.lights.size(), 3u);
    for (const Light& light : scene.lights) {
      EXPECT_FALSE(light.is_seen);
      const auto& ball = std::get<SphereLight>(light.source);
      const double radius = std::sqrt(6.) * size * 1000;
      EXPECT_NEAR(length(ball.center - Vec3d(7, 0, -1) * (size * 1000)), 4 * radius, 1e-3 * radius);
    }
  }
}

// Claim: nodes are held in a few hundred bytes each, and the plan is told of them. Fails if the JSON of all is held at once:
// a gigabyte for a million of them.
TEST(GltfScenes, ManyNodesTakeLittleMemory) {
  Asset asset = cube_asset();
  constexpr std::size_t kNodes = 100000;
  for (std::size_t i = 0; i < kNodes; ++i) asset.json["nodes"].push_back(Json::object());
  const Scene scene = scene_of(asset.glb(), "a.glb");
  EXPECT_GT(scene.asset_bytes, kNodes * 50);
  EXPECT_LT(scene.asset_bytes, kNodes * 200);
}

// Claim: what has no triangles, and what a node's transform flattens, is left out and said. Fails if a mesh of points
// ends the import.
TEST(GltfScenes, WhatCannotBeShownIsSaid) {
  Asset asset = cube_asset();
  asset.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  asset.root(asset.node({{"mesh", 0}, {"scale", {1, 0, 1}}, {"name", "flat"}}));
  asset.json["extensionsUsed"] = {"KHR_xmp", "KHR_lights_punctual"};
  asset.json["extensionsRequired"] = {"EXT_unknown"};
  const ImportedAsset import = imported(asset);
  for (const char* line :
       {"meshes[0] primitives[1]: it has no triangles", "node 'flat': its transform is singular",
        "extension 'KHR_xmp'", "extension 'EXT_unknown': required by the asset, but not supported"})
    EXPECT_TRUE(has(import.not_carried, line)) << line;
  EXPECT_EQ(import.not_carried.size(), 4u);
  EXPECT_EQ(scene_of(asset.glb(), "a.glb").shapes.size(), 1u);
}

}  // namespace
}  // namespace opaline::asset_test
