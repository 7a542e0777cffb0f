// SPDX-License-Identifier: GPL-3.0-or-later
// Skins, morph targets and instances of glTF.
#include <cmath>

#include "asset_test.h"
#include "geometry/world.h"

namespace opaline::asset_test {
namespace {

/// A strip of two triangles from x = 0 to 2, whose four vertices follow these joints with these weights, at a node that is
/// moved far away.
Asset skinned_strip(const std::vector<std::uint8_t>& joints, const std::vector<float>& weights) {
  Asset asset;
  const int positions = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0});
  const int normals = asset.accessor<float>("VEC3", kFloat, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int indices = asset.accessor<std::uint16_t>("SCALAR", kUnsignedShort, {0, 2, 1, 1, 2, 3});
  asset.mesh({{"attributes",
               {{"POSITION", positions},
                {"NORMAL", normals},
                {"JOINTS_0", asset.accessor("VEC4", kUnsignedByte, joints)},
                {"WEIGHTS_0", asset.accessor("VEC4", kFloat, weights)}}},
              {"indices", indices}});
  asset.node({{"mesh", 0}, {"skin", 0}, {"translation", {1000, 0, 0}}, {"scale", {7, 7, 7}}});
  asset.root(0);
  return asset;
}

/// Adds the joints, nodes 1, 2, ..., beneath an armature that makes all a tenth as large, and the skin of them.
void add_skin(Asset& asset, const std::vector<Json>& joints, const std::vector<float>& inverse_bind) {
  Json indices = Json::array();
  for (const Json& joint : joints) indices.push_back(asset.node(joint));
  asset.root(asset.node({{"name", "armature"}, {"scale", {.1, .1, .1}}, {"children", indices}}));
  Json skin{{"joints", indices}};
  if (!inverse_bind.empty()) skin["inverseBindMatrices"] = asset.accessor("MAT4", kFloat, inverse_bind);
  asset.json["skins"] = Json::array({skin});
}

/// Vertices of the scene's only shape, in metres.
std::vector<Vec3d> vertices_of(const Asset& asset) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  const Scene scene = load_scene(folder.file("a.glb"));
  EXPECT_EQ(scene.shapes.size(), 1u);
  std::vector<Vec3d> all;
  for (const Vec3d& p : make_mesh(scene.shapes.at(0)).mesh.positions) all.push_back(p / 1000);
  return all;
}

void expect_vertex(const std::vector<Vec3d>& all, const Vec3d& wanted) {
  double nearest = INFINITY;
  for (const Vec3d& p : all) nearest = std::min(nearest, length(p - wanted));
  EXPECT_LT(nearest, 1e-6) << wanted.x << ' ' << wanted.y << ' ' << wanted.z;
}

const std::vector<float> kOneJoint{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
const std::vector<std::uint8_t> kFirst(16, 0);

// Claim: a skinned mesh stands where its joints are, whatever the transform of its node: a ball of radius 2 beneath an
// armature scaled by .01 has an area of 4 pi 20^2 mm^2. Tolerance: of its facets, .4 %. Source: glTF 2.0, section 3.7.3.3.
// Fails if the node's transform is taken: 10,000 times the area.
TEST(GltfPoses, ASkinIgnoresItsNode) {
  const Scene scene = load_scene(OPALINE_TEST_INPUTS "/skin_root.glb");
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_NEAR(surface_area(make_mesh(scene.shapes[0]).mesh), 5009, 1);
  EXPECT_TRUE(scene.warnings.empty());
}

// Claim: each vertex is at the weighted mean of its joints' world matrices times their inverse bind matrices; without
// those they are the identity. Source: as above. Fails if joints are placed by their own transform alone, or the inverse
// bind matrix is left out.
TEST(GltfPoses, VerticesFollowSeveralJoints) {
  Asset asset = skinned_strip({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
                              {1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, .25, .75, 0, 0});
  std::vector<float> inverse;
  for (const float x : {0.f, -2.f})
    for (const float m : {1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, x, 0.f, 0.f, 1.f})
      inverse.push_back(m);
  add_skin(asset, {{{"translation", {0, 0, 0}}}, {{"translation", {2, 0, 5}}}}, inverse);
  const std::vector<Vec3d> moved = vertices_of(asset);
  expect_vertex(moved, {0, 0, 0});
  expect_vertex(moved, {0, .1, 0});
  expect_vertex(moved, {.2, 0, .5});
  expect_vertex(moved, {.2, .1, .375});
  Asset without = skinned_strip(kFirst, kOneJoint);
  add_skin(without, {{{"translation", {3, 0, 0}}}}, {});
  expect_vertex(vertices_of(without), {.5, .1, 0});
}

// Claim: weights that do not sum to 1 are scaled to, with a warning; a vertex without weights follows its first joint.
// Fails if the mesh shrinks towards the origin.
TEST(GltfPoses, WeightsAreScaledToOne) {
  std::vector<float> weights = kOneJoint;
  weights[0] = .5f;
  weights[12] = 0;
  Asset asset = skinned_strip(kFirst, weights);
  add_skin(asset, {{{"translation", {3, 0, 0}}}}, {});
  const std::vector<Vec3d> moved = vertices_of(asset);
  expect_vertex(moved, {.3, 0, 0});
  expect_vertex(moved, {.5, .1, 0});
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  EXPECT_TRUE(has(mesh_of(folder.file("a.glb"), "0/0/0").report.warnings,
                  "the joints' weights of 2 vertices do not sum to 1"));
}

// Claim: what is wrong with a skin is named by its accessor or record. Fails if a joint is read beyond the skin.
TEST(GltfPoses, BadSkinsAreNamed) {
  const auto error = [](
                         const std::vector<std::uint8_t>& joints, const std::vector<float>& weights,
                         const std::function<void(Json&)>& spoil = [](Json&) {}) {
    Asset asset = skinned_strip(joints, weights);
    add_skin(asset, {Json::object()}, {});
    spoil(asset.json);
    return error_of(asset.glb(), "a.glb");
  };
  std::vector<std::uint8_t> joints = kFirst;
  joints[5] = 1;
  EXPECT_EQ(error(joints, kOneJoint),
            "a.glb: accessors[3] element 1 names no joint (expected below 1, got 1)");
  std::vector<float> weights = kOneJoint;
  weights[4] = -1;
  EXPECT_TRUE(error(kFirst, weights)
                  .starts_with("a.glb: accessors[4] element 1 is not a weight (expected 0 or more"));
  EXPECT_TRUE(
      error(kFirst, kOneJoint, [](Json& j) {
        j["accessors"][3]["count"] = 3;
      }).starts_with("a.glb: accessors[3] has the wrong number of vertices for the skin (expected 4"));
  EXPECT_TRUE(error(kFirst, kOneJoint, [](Json& j) {
                j["accessors"][3]["componentType"] = 5120;
              }).starts_with("a.glb: accessors[3] cannot hold indices"));
  EXPECT_TRUE(error(kFirst, kOneJoint, [](Json& j) {
                j["skins"][0]["joints"] = {99};
              }).starts_with("a.glb: skins[0].joints refers to nothing"));
  EXPECT_TRUE(error(kFirst, kOneJoint, [](Json& j) {
                j["skins"][0]["joints"] = Json::array();
              }).starts_with("a.glb: skins[0].joints is empty"));
  EXPECT_TRUE(error(kFirst, kOneJoint, [](Json& j) {
                j["skins"][0]["inverseBindMatrices"] = 0;
              }).starts_with("a.glb: accessors[0] is of the wrong type (expected MAT4, got VEC3)"));
  EXPECT_TRUE(error(kFirst, kOneJoint, [](Json& j) {
                j["nodes"][0]["skin"] = 1;
              }).starts_with("a.glb: nodes[0].skin refers to nothing"));
}

// Claim: the weights of a node, or else of its mesh, morph it; weights of 0 leave it alone; their number must be that of
// the targets. Source: glTF 2.0, section 3.7.2.2. Fails if the mesh's weights win, or a part says nothing of its node.
TEST(GltfPoses, WeightsMorph) {
  Asset asset;
  const int positions = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int up = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 0, 0, 0, 0, 1, 0});
  asset.mesh({{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", up}}}}});
  asset.json["meshes"][0]["weights"] = {.5};
  asset.root(asset.node({{"mesh", 0}, {"scale", {2, 2, 2}}}));
  expect_vertex(vertices_of(asset), {0, 3, 0});
  asset.json["nodes"][0]["weights"] = {1};
  expect_vertex(vertices_of(asset), {0, 4, 0});
  asset.json["nodes"][0]["weights"] = {0};
  expect_vertex(vertices_of(asset), {0, 2, 0});
  asset.json["nodes"][0]["weights"] = {1, 1};
  EXPECT_TRUE(
      error_of(asset.glb(), "a.glb")
          .starts_with("a.glb: meshes[0].primitives[0] does not have as many morph targets as weights"));
}

// Claim: EXT_mesh_gpu_instancing shows a mesh at each of its transforms, behind the node's own. Source: the extension.
// Fails if there is one shape, or their order is another.
TEST(GltfPoses, InstancesAreShapes) {
  Asset asset = cube_mesh();
  const int translations = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 3, 0, 0, 0, 5, 0});
  const int rotations = asset.accessor<float>("VEC4", kFloat, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1});
  asset.root(asset.node({{"mesh", 0},
                         {"scale", {2, 2, 2}},
                         {"extensions",
                          {{"EXT_mesh_gpu_instancing",
                            {{"attributes", {{"TRANSLATION", translations}, {"ROTATION", rotations}}}}}}}}));
  const Scene scene = scene_of(asset.glb(), "a.glb");
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_NEAR(length(scene.shapes[1].to_world.translation - Vec3d(6000, 0, 0)), 0, 1e-9);
  EXPECT_NEAR(length(scene.shapes[2].to_world.x / 1000 - Vec3d(0, 2, 0)), 0, 1e-6);  // a quarter turn about z
  EXPECT_NE(scene.shapes[0].name, scene.shapes[1].name);
  asset.json["accessors"][rotations]["count"] = 2;
  EXPECT_TRUE(
      error_of(asset.glb(), "a.glb").starts_with("a.glb: accessors[3] has the wrong number of instances"));
}

}  // namespace
}  // namespace opaline::asset_test
