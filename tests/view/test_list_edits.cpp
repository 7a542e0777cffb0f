// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of the page that concern several values: snapshots, media, a floor, keys; and the bounds of shapes.
#include "../support/scenes.h"
#include "opaline/error.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;
using Texts = std::vector<std::string>;

SetValues set_of(const std::string& path, const std::string& value, std::uint64_t stroke = 0) {
  return {{{path, value}}, stroke};
}

using Replacements = std::vector<std::pair<std::string, std::string>>;

/// The scene of ViewFolder with replaced parts of its text.
struct ChangedFolder : ViewFolder {
  std::string text = bytes_of(scene);

  explicit ChangedFolder(const Replacements& changes) {
    for (const auto& [old, now] : changes) {
      EXPECT_NE(text.find(old), std::string::npos) << old;
      text.replace(text.find(old), old.size(), now);
    }
    put_bytes(scene, text);
  }
};

const std::pair<std::string, std::string> kMovingCamera{
    "[0, 30, 120]", R"({"keyed": {"1": [0, 30, 120], "9": [40, 30, 100]}, "between": "spline"})"};

// Claim: the edits of a snapshot replace all others as one step, also those that name files and were made by the view; others
// that do are refused. Fails if recalled edits are added to the present ones, or if undo loses them.
TEST(ListEdits, SnapshotsAreRecalled) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {});
  edits.set(set_of("media.stone.specular_ior", "1.4"));
  edits.change_lights({ChangeLights::Change::remove, 0});
  const Texts kept = edits.edits();
  edits.set(set_of("media.stone.specular_ior", "1.6"));
  edits.set(set_of("film.exposure", "1"));
  const Texts later = edits.edits();
  edits.recall(kept);
  EXPECT_EQ(edits.edits(), kept);
  EXPECT_DOUBLE_EQ(edits.scene().media[0].eta, 1.4);
  EXPECT_EQ(edits.scene().film.exposure, 0);
  const std::uint32_t revision = edits.revision();
  edits.recall(kept);
  EXPECT_EQ(edits.revision(), revision);
  edits.undo();
  EXPECT_EQ(edits.edits(), later);
  EXPECT_THROW(edits.recall({R"(shapes.0.file="/etc/passwd")"}), Error);
  EXPECT_THROW(edits.recall({"media.stone.specular_ior=11"}), Error);
  EXPECT_EQ(edits.edits(), later);
}

// Claim: a renamed medium takes all references along, of shapes and of layers, with its keys and edits; the saved file has the new
// name in the old one's place, comments included; undo gives the old one back. Fails if a layer keeps the old name, or if the
// text of the media is written anew.
TEST(ListEdits, MediaAreRenamed) {
  const ChangedFolder folder(Replacements{{R"("media": {"stone": {"preset": "marble"}},)", R"("media": {
    "stone": {"preset": "marble", "specular_ior": {"keyed": {"1": 1.3, "5": 1.7}}},  // from the quarry
    "glazed": {"layers": [{"medium": "skin", "thickness": 1}, {"medium": "stone"}]}, /* twice */
    "skin": {"preset": "skin1"}
  },)"}});
  SceneEdits edits(folder.scene, {"shapes.left.medium=glazed"});
  edits.set(set_of("media.skin.specular_roughness", "0.25"));
  edits.rename_medium({"skin", "hide-2"});
  edits.go_to_frame(3);
  edits.rename_medium({"stone", "gneiss"});
  const Scene& scene = edits.scene();
  ASSERT_EQ(scene.media.size(), 3u);
  EXPECT_EQ(scene.media[0].name, "gneiss");
  EXPECT_DOUBLE_EQ(scene.media[0].eta, 1.5);
  EXPECT_EQ(scene.media[2].name, "hide-2");
  EXPECT_DOUBLE_EQ(scene.media[2].specular_roughness, .25);
  EXPECT_EQ(scene.shapes[0].medium, 1u);
  EXPECT_EQ(scene.shapes[1].medium, 0u);
  EXPECT_EQ(scene.media[1].layers.size(), 2u);
  const std::string saved = edits.file_text();
  for (
      const char* part :
      {R"("gneiss": {"preset": "marble", "specular_ior": {"keyed": {"1": 1.3, "5": 1.7}}},  // from the quarry)",
       R"({"medium": "gneiss"}]}, /* twice */)", R"(// comments are no part of a scene)"})
    EXPECT_NE(saved.find(part), std::string::npos) << saved;
  EXPECT_EQ(saved.find("\"stone\""), std::string::npos);
  EXPECT_EQ(parse_scene(saved, folder.scene, {}, 3), edits.scene());
  edits.undo();
  EXPECT_EQ(edits.scene().media[0].name, "stone");
}

// Claim: a medium may be named "keyed", as in scene files, and the saved scene opens. Fails if that member is taken for keys.
TEST(ListEdits, AMediumMayBeNamedKeyed) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {});
  edits.rename_medium({"stone", "keyed"});
  put_bytes(folder.file("saved.json"), edits.file_text());
  EXPECT_EQ(SceneEdits(folder.file("saved.json"), {}).scene().media[0].name, "keyed");
}

// Claim: a floor of a renamed medium can be removed. Fails if the new name is given by the index of the shape.
TEST(ListEdits, TheFloorOfARenamedMediumCanBeRemoved) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {});
  edits.remove_floor();
  edits.add_floor({-60, -10, -60}, {60, 20, 60});
  const std::string name = edits.scene().shapes.back().name;
  edits.set(set_of("shapes." + name + ".medium", "\"stone\""));
  edits.rename_medium({"stone", "gneiss"});
  EXPECT_EQ(edits.scene().shapes.back().medium, edits.scene().shapes[0].medium);
  edits.remove_floor();
  EXPECT_NE(edits.scene().shapes.back().name, name);
}

// Claim: names that are no names, or taken, are refused with the reason, and change nothing.
TEST(ListEdits, MediaNamesAreChecked) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {R"(media.jade={"preset": "jade"})"});
  const auto refusal = [&](const std::string& name, const std::string& to) {
    try {
      edits.rename_medium({name, to});
    } catch (const Error& error) {
      return error.message;
    }
    return std::string();
  };
  EXPECT_EQ(refusal("stone", "jade"), "there is already a medium 'jade'");
  EXPECT_EQ(refusal("wax", "stone-2"), "there is no medium 'wax'");
  for (const std::string name : {"", "a b", "a.b", "a=b", "\"a\"", "*", "\xc3\xa4", "a\n"})
    EXPECT_TRUE(refusal("stone", name).ends_with("is not a valid name of a medium")) << name;
  EXPECT_NE(refusal("stone", std::string(65, 'a')), "");
  EXPECT_EQ(refusal("stone", "stone"), "");
  EXPECT_EQ(edits.revision(), 1u);
}

// Claim: the floor is a diffuse square just below everything, in the scene's unit, named as no other shape; removing it takes the edits
// of it away, and both are undone as one step; in the saved file it follows the other shapes, whose comments stay. Fails if
// the bounds are taken in millimetres, or if the list of shapes is written anew.
TEST(ListEdits, FloorsComeAndGo) {
  const ChangedFolder folder(
      Replacements{{R"("radius": 10}, "medium")", R"("radius": 10 /* round */}, "medium")"}});
  SceneEdits edits(folder.scene, {"mm_per_unit=10"});
  EXPECT_FALSE(edits.has_floor());
  edits.add_floor({-600, -10, -600}, {600, 200, 600});
  ASSERT_EQ(edits.scene().shapes.size(), 4u);
  EXPECT_EQ(edits.scene().shapes[3].name, "floor-2");
  const auto& quad = std::get<QuadShape>(edits.scene().shapes[3].source);
  EXPECT_LT(quad.corner.y, -10);
  EXPECT_GT(quad.corner.y, -15);
  EXPECT_NEAR(quad.corner.x + quad.u.x / 2, 0, 1e-6);
  EXPECT_GT(quad.u.x, 10000);
  EXPECT_GT(cross(quad.u, quad.v).y, 0);
  EXPECT_FALSE(edits.scene().shapes[3].medium);
  edits.add_floor({-1, -1, -1}, {1, 1, 1});
  EXPECT_EQ(edits.edits().size(), 1u);
  edits.set(set_of("shapes.floor-2.reflectance", "[0.5, 0.4, 0.3]"));
  edits.set(set_of("shapes.floor.reflectance", "0.25"));
  const std::string saved = edits.file_text();
  EXPECT_NE(saved.find("/* round */"), std::string::npos) << saved;
  EXPECT_EQ(parse_scene(saved, folder.scene), edits.scene());
  edits.remove_floor();
  EXPECT_FALSE(edits.has_floor());
  EXPECT_EQ(edits.edits(), Texts{"shapes.floor.reflectance=0.25"});
  EXPECT_EQ(edits.scene().shapes.size(), 3u);
  edits.undo();
  EXPECT_TRUE(edits.has_floor());
  EXPECT_EQ(edits.scene().shapes[3].reflectance, (Rgb{.5, .4, .3}));
}

// Claim: an edit of a list keeps the keys inside it: parts that it leaves alone, and keys at other frames of the part that
// it changes; the steps added behind are there at all frames. Fails if moving a shape of a shot writes one frame's values.
TEST(ListEdits, KeysInListsStay) {
  const ChangedFolder folder(
      Replacements{{R"([{"translate": [15, 10, 0]}])", R"([{"scale": {"keyed": {"1": 1, "5": 2}}},
    {"translate": {"keyed": {"1": [15, 10, 0], "5": [25, 10, 0]}}}])"}});
  SceneEdits edits(folder.scene, {});
  const auto at = [&](int frame) {
    return parse_scene(edits.file_text(), folder.scene, {}, frame).shapes[1].to_world;
  };
  edits.go_to_frame(3);
  edits.set(set_of("shapes.right.transform", R"([{"scale": 1.5}, {"translate": [20, 12, 0]}])", 1));
  edits.set(set_of("shapes.right.transform", R"([{"scale": 1.5}, {"translate": [20, 14, 0]}])", 1));
  EXPECT_EQ(at(3).translation, (Vec3d{20, 14, 0}));
  EXPECT_EQ(at(1).translation, (Vec3d{15, 10, 0}));
  EXPECT_EQ(at(5).translation, (Vec3d{25, 10, 0}));
  EXPECT_DOUBLE_EQ(at(3).x.x, 1.5);
  EXPECT_DOUBLE_EQ(at(5).x.x, 2);
  edits.set(
      set_of("shapes.right.transform", R"([{"scale": 1.5}, {"translate": [20, 14, 0]}, {"scale": 2}])"));
  EXPECT_EQ(at(1).translation, (Vec3d{30, 20, 0}));
  edits.set(set_of("shapes.right.transform", R"([{"translate": [1, 2, 3]}])"));  // another list
  for (const int frame : {1, 3, 5}) EXPECT_EQ(at(frame).translation, (Vec3d{1, 2, 3}));
  edits.undo();
  edits.undo();
  edits.undo();
  EXPECT_EQ(edits.file_text(), folder.text);
}

// Claim: steps put in front of keyed ones leave their keys, as when a moving shape is turned or scaled. Fails if elements are
// paired by their index.
TEST(ListEdits, KeysStayBehindNewSteps) {
  const ChangedFolder folder(
      Replacements{{R"([{"translate": [15, 10, 0]}])",
                    R"([{"rotate": {"axis": [0, 1, 0], "degrees": {"keyed": {"1": 0, "5": 90}}}},
    {"translate": {"keyed": {"1": [15, 10, 0], "5": [25, 10, 0]}}}])"}});
  SceneEdits edits(folder.scene, {});
  edits.go_to_frame(5);
  edits.set(set_of("shapes.right.transform",
                   R"([{"scale": 2}, {"rotate": {"axis": [1, 0, 0], "degrees": 30}},
                       {"rotate": {"axis": [0, 1, 0], "degrees": 90}}, {"translate": [25, 10, 0]}])"));
  const auto at = [&](int frame) {
    return parse_scene(edits.file_text(), folder.scene, {}, frame).shapes[1].to_world;
  };
  EXPECT_EQ(at(1).translation, (Vec3d{15, 10, 0}));
  EXPECT_EQ(at(5).translation, (Vec3d{25, 10, 0}));
  EXPECT_NEAR(at(1).x.x, 2, 1e-12);  // not turned about y
  EXPECT_NEAR(at(5).x.z, -2, 1e-12);
}

// Claim: a key of the camera at a frame leaves the views at all other keys as they are, also where only its position was
// keyed. Fails if the point of interest changes at all frames.
TEST(ListEdits, TheCameraGetsAKey) {
  const ChangedFolder folder(Replacements{kMovingCamera});
  SceneEdits edits(folder.scene, {});
  const auto camera = [&](int frame) {
    return parse_scene(edits.file_text(), folder.scene, {}, frame).camera;
  };
  const Camera first = camera(1), last = camera(9);
  edits.go_to_frame(5);
  edits.key_look();
  EXPECT_FALSE(edits.can_undo());  // no free camera
  edits.look({"[20, 50, 90]", "[3, 8, 0]"});
  edits.key_look();
  EXPECT_FALSE(edits.own_camera());
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{20, 50, 90}));
  EXPECT_EQ(edits.scene().camera.look_at, (Vec3d{3, 8, 0}));
  EXPECT_EQ(camera(1), first);
  EXPECT_EQ(camera(9), last);
  edits.look({"[20, 55, 90]", "[3, 8, 0]"});
  edits.key_look();
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{20, 55, 90}));
  EXPECT_EQ(edits.scene().camera.look_at, (Vec3d{3, 8, 0}));
  edits.undo();
  edits.undo();
  EXPECT_EQ(edits.file_text(), folder.text);
}

// Claim: in a scene with frames and a still camera, the first key changes nothing else, and the second makes it move.
TEST(ListEdits, AStillCameraBeginsToMove) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {}, {1, 2, 3, 4, 5});
  for (const auto& [frame, x] : std::vector<std::pair<int, std::string>>{{1, "0"}, {5, "40"}}) {
    edits.go_to_frame(frame);
    edits.look({"[" + x + ", 40, 120]", "[0, 8, 0]"});
    edits.key_look();
  }
  edits.go_to_frame(3);
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{20, 40, 120}));
  EXPECT_EQ(edits.scene().camera.look_at, (Vec3d{0, 8, 0}));
  SceneEdits still(folder.scene, {});
  still.look({"[0, 40, 120]", "[0, 8, 0]"});
  still.key_look();
  EXPECT_TRUE(still.edits().empty());
}

// Claim: pages know the bounds of all shapes where they are, in the scene's unit, and a floor is added below them; a
// refused request is answered. Fails if the bounds are those before a transform.
TEST(ListEdits, PagesKnowTheBounds) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  page.set({{"mm_per_unit", 2},
            {"shapes.right.transform", nlohmann::json::parse(R"([{"translate": [15, 30, 0]}])")}});
  ASSERT_TRUE(page.read_final(2));
  const nlohmann::json& boxes = page.texts.at("plan").at("boxes");
  ASSERT_EQ(boxes.size(), 3u);
  const auto expect_near = [&](const nlohmann::json& point, const std::array<double, 3>& expected) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(point.at(i).get<double>(), expected[i], .05);
  };
  expect_near(boxes.at(0).at(0), {-25, 0, -10});
  expect_near(boxes.at(0).at(1), {-5, 20, 10});
  expect_near(boxes.at(1).at(0), {5, 20, -10});
  expect_near(boxes.at(1).at(1), {25, 40, 10});
  EXPECT_FALSE(page.texts.at("scene").at("floor"));
  page.send({{"do", "floor"}, {"on", true}});
  ASSERT_TRUE(page.read_final(3));
  EXPECT_TRUE(page.texts.at("scene").at("floor"));
  EXPECT_LT(page.texts.at("plan").at("boxes").at(3).at(1).at(1), -1);
  page.send({{"do", "floor"}, {"on", false}});
  ASSERT_TRUE(page.read_final(4));
  EXPECT_EQ(page.texts.at("scene").at("scene").at("shapes").size(), 3u);
  page.send({{"do", "rename_medium"}, {"name", "stone"}, {"to", "a b"}});
  EXPECT_NE(page.read_answer().find("not a valid name"), std::string::npos);
}

}  // namespace
}  // namespace opaline
