// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of a scene: each a step that can be taken back, and a file that can be read again.
#include "../assets/asset_test.h"
#include "../support/pictures.h"
#include "../support/scenes.h"
#include "opaline/error.h"
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;
using Words = std::vector<std::string>;

SetValues one(const std::string& path, const std::string& value, std::uint64_t stroke = 0) {
  return {{{path, value}}, stroke};
}

// Claim: a value replaces the one of its path and those within it; a stroke is one step; what fails or changes
// nothing is none; a new step forgets what could be redone.
TEST(SceneEdits, StepsAndStrokes) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {"media.stone.eta=1.6"});
  EXPECT_FALSE(edits.can_undo() || edits.can_redo());
  edits.set(one("media.stone.eta", "1.4", 1));
  edits.set(one("media.stone.eta", "1.5", 1));
  edits.set(one("media.stone.eta", "1.45", 2));
  EXPECT_EQ(edits.edits(), Words{"media.stone.eta=1.45"});
  EXPECT_DOUBLE_EQ(edits.scene().media[0].eta, 1.45);
  EXPECT_THROW(edits.set(one("media.stone.eta", "11", 2)), Error);
  EXPECT_EQ(edits.revision(), 4u);
  edits.set(one("media.stone.eta", "1.45", 3));
  EXPECT_EQ(edits.revision(), 4u);
  edits.set(one("media.stone", R"({"preset": "skin1"})"));
  EXPECT_EQ(edits.edits(), Words{R"(media.stone={"preset": "skin1"})"});
  edits.undo();
  edits.undo();
  EXPECT_DOUBLE_EQ(edits.scene().media[0].eta, 1.5);
  edits.undo();
  EXPECT_DOUBLE_EQ(edits.scene().media[0].eta, 1.6);  // of the command line
  EXPECT_FALSE(edits.can_undo());
  edits.redo();
  edits.set(one("media.stone.eta", "1.7", 1));  // the stroke has ended
  EXPECT_FALSE(edits.can_redo());
  edits.reset();
  EXPECT_TRUE(edits.edits().empty());
  edits.undo();
  EXPECT_DOUBLE_EQ(edits.scene().media[0].eta, 1.7);
  EXPECT_EQ(edits.overrides(), (Words{"media.stone.eta=1.6", "media.stone.eta=1.7"}));
}

// Claim: no edit opens a file, by its key, in an object, or spelled with escapes; the error does not tell whether it is
// there. Fails if: the check looks at meshes alone, after the scene with its pictures has been read.
TEST(SceneEdits, OpenNoFiles) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {});
  for (const auto& [path, value] : std::vector<std::pair<std::string, std::string>>{
           {"shapes.0.file", R"("/etc/passwd")"},
           {"lights.0", R"({"type": "environment", "file": "/etc/passwd"})"},
           {"shapes.0.reflectance", R"({"texture": "/etc/passwd"})"},
           {"shapes.0.reflectance.texture", R"("/etc/passwd")"},
           {"shapes.0.reflectance", R"({"spectrum": "/etc/passwd"})"},
           {"texture", R"("/etc/passwd")"},
           {R"(shapes.0.reflectance."texture")", R"("/etc/passwd")"},
           {"shapes.0.reflectance.'spectrum'", R"("/etc/passwd")"},
           {"lights.0", R"({"type": "environment", "\u0066ile": "/etc/passwd"})"}})
    try {
      edits.set(one(path, value));
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.message, "the view cannot change files") << error.what();
    }
}

// Claim: the view's own camera is in the scene that is shown and in nothing that is saved, copied or undone; kept, it is
// one step, of what differs alone; an edit of where the scene's camera is ends it, one of its angle does not.
TEST(SceneEdits, OwnCamera) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene, {});
  edits.set(one("media.stone.eta", "1.4"));
  const std::string json = edits.json(), text = edits.file_text();
  edits.look({"[10, 20, 90]", "[0, 8, 0]"});
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{10, 20, 90}));
  EXPECT_EQ(edits.json(), json);
  EXPECT_EQ(edits.file_text(), text);
  EXPECT_EQ(edits.overrides(), Words{"media.stone.eta=1.4"});
  EXPECT_THROW(edits.look({"[0, 8, 0]", "[0, 8, 0]"}), Error);
  EXPECT_THROW(edits.look({"[0, 8]", "[0, 8, 0]"}), Error);
  edits.undo();
  EXPECT_FALSE(edits.can_undo());
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{10, 20, 90}));
  edits.keep_look();
  EXPECT_FALSE(edits.own_camera());
  EXPECT_EQ(edits.edits(), Words{"camera.position=[10, 20, 90]"});
  edits.undo();
  EXPECT_EQ(edits.scene().camera, load_scene(folder.scene).camera);
  edits.look({"[10, 20, 90]", "[1, 8, 0]"});
  edits.set(one("camera.field_of_view", "20"));
  EXPECT_TRUE(edits.own_camera());
  EXPECT_THROW(edits.set(one("camera.up", "[0, -22, -120]")), Error);  // along the scene's own line of sight
  edits.set(one("camera.position", "[0, 40, 120]"));
  EXPECT_FALSE(edits.own_camera());
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{0, 40, 120}));
  edits.look({"[10, 20, 90]", "[1, 8, 0]"});
  edits.look_back();
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{0, 40, 120}));
}

// Claim: the default lights of an asset stay where the command line's camera places them, whatever the page does to the camera or
// the size; the page's command and its saved file make the same lights, and the command names them only where it would place
// others. Source: scene_edits.h. Fails if: an edit or its command lights the asset for another camera.
TEST(SceneEdits, DefaultLightsOfAssetsStay) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.glb");
  put_bytes(file, asset_test::cube_asset().glb());
  for (const Words& given : {Words{}, Words{"camera.position=[-3, -4, -6]"}}) {
    const std::vector<Light> lights = load_scene(file, given).lights;
    SceneEdits edits(file, given);
    EXPECT_EQ(edits.scene().lights, lights);
    edits.set(one("film.exposure", "1"));
    EXPECT_EQ(edits.overrides().size(), given.size() + 1);
    edits.look({"[9, 2, -5]", "[0, 0, 0]"});
    EXPECT_EQ(edits.scene().lights, lights);
    EXPECT_EQ(edits.overrides().size(), given.size() + 1);
    edits.keep_look();
    for (const SetValues& change : {one("camera.up", "[0, 1, .1]"), one("shapes.0.fit_size", "20")}) {
      edits.set(change);
      EXPECT_EQ(edits.scene().lights, lights);
      const Scene repeated = load_scene(file, edits.overrides());
      EXPECT_EQ(repeated.lights, lights);
      EXPECT_EQ(repeated.camera, edits.scene().camera);
      EXPECT_EQ(parse_scene(edits.file_text(), folder.file("a.json")).lights, lights);
    }
  }
}

// Claim: an edit of a value with keys sets its key at the frame that is shown, and all others stay, in the saved file,
// too; the view's own camera leaves them alone. Fails if: the edit takes the place of the value with its keys.
TEST(SceneEdits, KeysStay) {
  const ViewFolder folder;
  std::string text = bytes_of(folder.scene);
  const auto key = [&](const std::string& still, const std::string& keyed) {
    text.replace(text.find(still), still.size(), keyed);
  };
  key("[0, 30, 120]", R"({"keyed": {"1": [0, 30, 120], "9": [40, 30, 100]}, "between": "spline"})");
  key("[3e4, 2e4, 1e4]", R"({"keyed": {"1": [3e4, 2e4, 1e4], "5": [1, 2, 3]}})");
  put_bytes(folder.scene, text);
  SceneEdits edits(folder.scene, {});
  edits.go_to_frame(4);
  edits.look({"[7, 8, 90]", "[1, 8, 0]"});
  EXPECT_EQ(edits.file_text(), text);
  edits.set(one("lights.key.intensity", "[5, 6, 7]", 3));
  edits.set(one("lights.0.intensity", "[6, 6, 7]", 3));
  EXPECT_EQ(edits.edits(),
            (Words{"lights.key.intensity.keyed.4=[5, 6, 7]", "lights.0.intensity.keyed.4=[6, 6, 7]"}));
  const auto lamp = [&] { return std::get<PointLight>(edits.scene().lights[0].source).intensity; };
  EXPECT_EQ(lamp(), (Rgb{6, 6, 7}));
  edits.go_to_frame(1);
  EXPECT_EQ(lamp(), (Rgb{3e4, 2e4, 1e4}));
  edits.undo();
  edits.go_to_frame(4);
  edits.keep_look();
  EXPECT_EQ(edits.edits(), (Words{"camera.position.keyed.4=[7, 8, 90]", "camera.look_at=[1, 8, 0]"}));
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{7, 8, 90}));
  const std::string saved = edits.file_text();
  for (const int frame : {1, 9})
    EXPECT_EQ(parse_scene(saved, "saved.json", {}, frame).camera.position,
              parse_scene(text, "before.json", {}, frame).camera.position);
  edits.set(one("camera.position", R"({"keyed": {"2": [1, 2, 3]}})"));  // other keys are meant
  EXPECT_EQ(edits.scene().camera.position, (Vec3d{1, 2, 3}));
}

// Claim: an environment map replaces keyed values at all frames, and edits naming it are left out by a new server, which
// restores the others. Fails if the values get a key at the shown frame, or if one refused edit loses all.
TEST(SceneEdits, EnvironmentMapsReplaceKeys) {
  const ViewFolder folder;
  put_exr(folder.file("sky.exr"), 8, 4, [](int, int) { return std::array<double, 3>{1, 1, 1}; });
  const Words keyed{R"(surroundings={"keyed": {"1": 0.1, "5": 0.9}})"};
  SceneEdits edits(folder.scene, keyed);
  edits.light_by(folder.file("sky.exr"));
  edits.set(one("media.stone.specular_ior", "1.4"));
  edits.go_to_frame(3);
  EXPECT_EQ(edits.scene().lights.size(), 1u);
  SceneEdits restarted(folder.scene, keyed);
  EXPECT_NE(restarted.restore(edits.edits()).find("sky.exr"), std::string::npos);
  EXPECT_DOUBLE_EQ(restarted.scene().media[0].eta, 1.4);
  EXPECT_EQ(restarted.scene().lights.size(), 3u);  // without surroundings
}

// Claim: lights are added, copied with a new name, and removed, each as one step; keys of a light and the file of an
// environment map stay. Fails if the list is that of the shown frame, if a file of the scene is refused, or if the new
// light misses the point of interest.
TEST(SceneEdits, LightsAreAddedAndRemoved) {
  const ViewFolder folder;
  put_exr(folder.file("sky.exr"), 8, 4, [](int, int) { return std::array<double, 3>{1, 1, 1}; });
  SceneEdits edits(folder.scene, {R"(lights.key.position={"keyed": {"1": [0, 100, 20], "9": [50, 100, 20]}})",
                                  R"(lights.sun={"type": "environment", "name": "sun", "file": "sky.exr"})"});
  edits.go_to_frame(5);
  using Change = ChangeLights::Change;
  edits.change_lights({Change::copy, 0});
  ASSERT_EQ(edits.scene().lights.size(), 4u);
  EXPECT_EQ(edits.scene().lights[3].name, "key-2");
  EXPECT_EQ(std::get<PointLight>(edits.scene().lights[3].source).position, (Vec3d{25, 100, 20}));
  edits.go_to_frame(9);
  EXPECT_EQ(std::get<PointLight>(edits.scene().lights[3].source).position, (Vec3d{50, 100, 20}));
  edits.change_lights({Change::remove, 0});
  EXPECT_EQ(edits.scene().lights[2].name, "key-2");
  edits.change_lights({Change::add});
  ASSERT_EQ(edits.scene().lights.size(), 4u);
  const auto& added = std::get<SphereLight>(edits.scene().lights[3].source);
  const Camera& camera = edits.scene().camera;
  EXPECT_NEAR(length(added.center - camera.look_at), length(camera.position - camera.look_at), 1e-9);
  EXPECT_GT(added.center.y, camera.look_at.y);
  EXPECT_NEAR(added.radiance.x * kPi * std::pow(added.radius / length(added.center - camera.look_at), 2), 3,
              .02);
  EXPECT_NO_THROW(parse_scene(edits.file_text(), folder.scene));
  EXPECT_THROW(edits.change_lights({Change::remove, 4}), Error);
  EXPECT_THROW(edits.change_lights({Change::copy, 1 << 30}), Error);
  for (int i = 0; i < 3; ++i) edits.undo();
  EXPECT_EQ(edits.scene().lights.size(), 3u);
  EXPECT_FALSE(edits.can_undo());
}

// Claim: the file's text with edits is read as the scene with edits, keyed values stay keyed, and only in what pages
// see they are those of the first frame.
TEST(SceneEdits, FileText) {
  const ViewFolder folder;
  SceneEdits edits(folder.scene,
                   {R"(camera.position={"keyed": {"1": [0, 32, 140], "24": [60.125, 32, 126]}})",
                    "settings.seed=18446744073709551615"});
  edits.set(one("lights.panel.radiance", "[0.1, 1e-9, 3]"));
  edits.set(one("shapes.0.normals", "\"faceted\""));
  const Scene again = parse_scene(edits.file_text(), folder.file("again.json"), {}, 24);
  Scene there = load_scene(folder.scene, edits.overrides(), 24);
  there.file = again.file;
  EXPECT_EQ(again, there);
  const Json seen = Json::parse(edits.json());
  EXPECT_EQ(seen.at("camera").at("position"), (Json{0, 32, 140}));
  EXPECT_EQ(seen.at("lights").at(1).at("radiance").at(1), 1e-9);
}

// Claim: the file with edits keeps the lines that they leave alone, comments included; a new value stands after the
// others of its object, and comments stay beside what they explain. Fails if the text is written from the tree.
TEST(SceneEdits, FileKeepsComments) {
  const ScratchFolder folder;
  const std::string file = folder.file("scene.json");
  put_bytes(file, R"(// A ball of stone.
{
  "media": {"stone": {"preset": "marble" /* as measured */}},
  "shapes": [ {"name": "ball", "sphere": {"center": [0,0,0], "radius": 10}, "medium": "stone"} ],
  "lights": [
    // the sun, "key": no {object}
    {"name": "key", "type": "point", "position": [0, 100, 20],
      "intensity": [3e4, 2e4, 1e4]  // warm
    }
  ],
  "camera": {"position": [0,  30, 120], "look_at": [0, 8, 0]}  // from the front
}
// the end
)");
  SceneEdits edits(file, {});
  EXPECT_EQ(edits.file_text(), bytes_of(file));
  edits.set(one("media.stone.eta", "1.4"));
  edits.set(one("lights.key.intensity", "[1, 2, 3]"));
  edits.set(one("lights.key.name", "\"lamp\""));
  edits.set(one("camera.position", "[0, 31, 120]"));
  edits.set(one("film.resolution", "[48, 32]"));
  edits.set(one("settings.seed", "7"));
  EXPECT_EQ(edits.file_text(), R"(// A ball of stone.
{
  "media": {"stone": {"preset": "marble", "specular_ior": 1.4 /* as measured */}},
  "shapes": [ {"name": "ball", "sphere": {"center": [0,0,0], "radius": 10}, "medium": "stone"} ],
  "lights": [
    // the sun, "key": no {object}
    {"name": "lamp", "type": "point", "position": [0, 100, 20],
      "intensity": [1, 2, 3]  // warm
    }
  ],
  "camera": {"position": [0,  31, 120], "look_at": [0, 8, 0]},  // from the front
  "film": {"resolution": [48, 32]},
  "settings": {"seed": 7}
}
// the end
)");
  edits.set(one("shapes.ball.reflectance", "0.3"));
  edits.set(one("shapes.ball.metalness", "1"));
  EXPECT_FALSE(edits.scene().shapes[0].medium);
  const auto saved = [&] { return parse_scene(edits.file_text(), file).shapes.at(0); };
  EXPECT_FALSE(saved().medium);
  EXPECT_EQ(saved().gloss, edits.scene().shapes[0].gloss);
  edits.set(SetValues{{{"media.skin", R"({"preset": "skin1"})"}, {"shapes.ball.medium", "\"skin\""}}, 0});
  EXPECT_EQ(edits.scene().media.at(*edits.scene().shapes[0].medium).name, "skin");
  EXPECT_EQ(saved().medium, edits.scene().shapes[0].medium);
  EXPECT_FALSE(saved().gloss);
  edits.undo();
  EXPECT_TRUE(edits.scene().shapes[0].gloss);
  edits.undo();
  edits.undo();
  edits.set(one("media.stone", R"({"sigma_a": [0.1, 0.1, 0.1], "sigma_s_prime": [1, 1, 1]})"));
  EXPECT_EQ(parse_scene(edits.file_text(), file), edits.scene());
  EXPECT_NE(edits.file_text().find("// warm"), std::string::npos);
}

}  // namespace
}  // namespace opaline
