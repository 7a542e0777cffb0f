// SPDX-License-Identifier: GPL-3.0-or-later
// Pages see the scene, its edits and its pictures, and each other's.
#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

std::vector<std::string> edits_of(const ViewClient& page) {
  return page.texts.at("scene").at("edits").get<std::vector<std::string>>();
}

// Claim: after each of a row of edits (and undo, redo, reset) the final picture has the bits of a new session's
// picture of the scene with these edits. Source: the help of view; the exactness of Session::match_new_session. Tolerance:
// none. Fails if: samples are carried or stay denser than a new session's (moved shape, changed medium), lights are
// mixed, or a picture is sent under another revision.
TEST(ViewServer, FinalPicturesAreThoseOfRender) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  EXPECT_EQ(page.frame.colours, rendered(folder.scene));
  const std::vector<Json> steps{
      {{"camera.position", {30, 20, 110}}, {"camera.look_at", {0, 9, 1}}},
      {{"lights.key.intensity", {1e4, 2e4, 3e4}}},
      {{"lights.key.position", {50, 60, 40}}},
      {{"media.stone", {{"sigma_a", {.01, .02, .03}}, {"sigma_s_prime", {.4, .5, .6}}, {"eta", 1.4}}}},
      {{"media.stone.sigma_s_prime", {.8, 1, 1.2}}},
      {{"media.stone.profile", "normalized_diffusion"}},
      {{"shapes.left.transform", {{{"translate", {1.5, .5, -2}}}}}},
      {{"shapes.right.transform", {{{"scale", {1.1, 1, .9}}}}}},
      {{"film.samples_per_pixel", 4}},
      {{"settings.evaluator", "classic"}},
      {{"settings.method", "lambert"}},
      {{"settings.method", "volume_diffusion"}, {"settings.samples", 500}},
  };
  for (const Json& values : steps) {
    SCOPED_TRACE(values.dump());
    page.set(values);
    ASSERT_TRUE(page.read_final(page.revision() + 1));
    EXPECT_EQ(page.frame.colours, rendered(folder.scene, edits_of(page)));
  }
  const std::vector<std::string> all = edits_of(page);
  for (const char* word : {"undo", "undo", "redo", "reset", "undo"}) {
    SCOPED_TRACE(word);
    page.send({{"do", word}});
    ASSERT_TRUE(page.read_final(page.revision() + 1));
    EXPECT_EQ(page.frame.colours, rendered(folder.scene, edits_of(page)));
  }
}

// Claim: a scene that is saved after edits is the scene that is shown, and only new names beside it are taken.
// Source: the help of view. Tolerance: none. Fails if: numbers lose digits on the way, or a path leaves the folder.
TEST(ViewServer, SavesWhatItShows) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  page.set({{"media.stone.eta", 1.4142135623730951}, {"camera.position", {1e-7, 33, 120.0000001}}});
  ASSERT_TRUE(page.read_final(2));
  for (const char* name : {"../a.json", "balls.json", ".json", "a.exr", "", "a/b.json", "/tmp/a.json"}) {
    page.send({{"do", "save"}, {"name", name}});
    EXPECT_NE(page.read_answer(), "");
    EXPECT_FALSE(page.texts["told"].at("good")) << name;
  }
  EXPECT_EQ(folder.entries(), 1u);
  for (int i = 0; i < 2; ++i) {  // its own file it may replace
    page.send({{"do", "save"}, {"name", "edited.json"}});
    page.read_answer();
    EXPECT_TRUE(page.texts["told"].at("good")) << page.texts["told"];
  }
  EXPECT_EQ(load_scene(folder.file("edited.json")).camera, load_scene(folder.scene, edits_of(page)).camera);
  EXPECT_EQ(rendered(folder.file("edited.json")), page.frame.colours);
  page.send({{"do", "render"}, {"name", "out.exr"}});
  EXPECT_NE(page.read_answer().find("rendering"), std::string::npos);
  EXPECT_NE(page.read_answer().find("rendered"), std::string::npos);
  EXPECT_EQ(bytes_of(folder.file("out.exr")), "a picture");
}

// Claim: a page ends the rendering of a file, of which no part is left, and may ask for another. Fails if the request is not
// heard while a file is rendered, or ends the next one.
TEST(ViewServer, AFileIsCancelled) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  const auto shows_progress = [&] {
    return page.texts.contains("file") && page.texts.at("file").at("stage") != "";
  };
  page.send({{"do", "render"}, {"name", "endless.exr"}});
  EXPECT_NE(page.read_answer().find("rendering"), std::string::npos);
  ASSERT_TRUE(page.read_until(shows_progress));
  page.send({{"do", "cancel_render"}});
  EXPECT_NE(page.read_answer().find("endless.exr: interrupted"), std::string::npos);
  EXPECT_EQ(folder.entries(), 1u);
  ASSERT_TRUE(page.read_until([&] { return !shows_progress(); }));
  page.send({{"do", "render"}, {"name", "out.exr"}});
  EXPECT_NE(page.read_answer().find("rendering"), std::string::npos);
  EXPECT_NE(page.read_answer().find("rendered"), std::string::npos);
}

// Claim: all pages see the same; what one asks for in vain the other does not hear; when one leaves, the other stays.
TEST(ViewServer, PagesSeeTheSame) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  auto first = std::make_optional<ViewClient>(view);
  ViewClient second(view);
  ASSERT_TRUE(first->read_final() && second.read_final());
  first->set({{"media.stone.eta", 1.3}}, 5);
  first->set({{"media.stone.eta", 1.2}}, 5);
  ASSERT_TRUE(first->read_final(3) && second.read_final(3));
  EXPECT_EQ(first->frame.colours, second.frame.colours);
  EXPECT_EQ(edits_of(second), std::vector<std::string>{"media.stone.eta=1.2"});
  first->set({{"media.stone.eta", 99}});
  EXPECT_NE(first->read_answer().find("'media.stone.specular_ior' is out of range"), std::string::npos)
      << first->texts["told"];
  first.reset();
  second.send({{"do", "undo"}});  // both values: they are one stroke
  ASSERT_TRUE(second.read_final(4));
  EXPECT_TRUE(edits_of(second).empty());
  EXPECT_FALSE(second.texts.contains("told"));
  ViewClient third(view);
  ASSERT_TRUE(third.read_final());
  EXPECT_EQ(third.frame.colours, rendered(folder.scene));
  EXPECT_EQ(third.texts.at("scene"), second.texts.at("scene"));
  third.send({{"do", "restore"}, {"edits", {"media.stone.eta=1.5"}}});  // of use to a new server alone
  third.send({{"do", "redo"}});
  ASSERT_TRUE(third.read_final(5));
  EXPECT_EQ(edits_of(third), std::vector<std::string>{"media.stone.eta=1.2"});
}

// Claim: a newer change ends the work on an older one at once, whatever that would take: here minutes.
TEST(ViewServer, ANewerChangeCancels) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  page.set({{"settings.method", "direct"}, {"settings.entry_samples", 10000000}});
  ASSERT_TRUE(page.read_until([&] { return page.frame.revision == 2; }));
  EXPECT_EQ(page.frame.step, PictureStep::moving);
  const auto start = std::chrono::steady_clock::now();
  page.set({{"settings.method", "lambert"}});
  ASSERT_TRUE(page.read_final(3));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

// Claim: a page that turns to a layer and back, and shows the last of the frames alone, goes on to get pictures. Fails if:
// what is shown is told by numbers that rise: that of a layer that was packed before is lower.
TEST(ViewServer, ALayerAndBackLeaveTheLineOpen) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  page.answers_frames = false;
  for (const char* layer : {"N", ""}) {
    const std::size_t before = page.frames;
    page.send({{"do", "layer"}, {"name", layer}});
    ASSERT_TRUE(page.read_until([&] { return page.frames > before; }));
  }
  page.send({{"do", "shown"}, {"frame", page.frame.number}});
  page.answers_frames = true;
  page.set({{"film.resolution", {20, 10}}});
  EXPECT_TRUE(page.read_final(2));
}

// Claim: frames bring the layer that a page chose, with the picture's values; the plan, the costs and the error are
// told beside them.
TEST(ViewServer, LayersAndReports) {
  const ViewFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  EXPECT_EQ(page.frame.layer_channels, 0u);
  page.send({{"do", "layer"}, {"name", "P"}});
  ASSERT_TRUE(page.read_until([&] { return page.frame.layer_channels == 3; }));
  Session session;
  session.edit(load_scene(folder.scene));
  const RenderResult cold = session.render();
  const auto first = std::size_t(std::ranges::find(cold.image.channels, "P.X") - cold.image.channels.begin());
  for (std::size_t p = 0; p < 48 * 32; ++p)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(page.frame.layer[p * 3 + c], cold.image.pixels[p * cold.image.channels.size() + first + c]);
  ASSERT_TRUE(page.read_until([&] { return page.texts.contains("report"); }));
  const Json& report = page.texts.at("report");
  EXPECT_DOUBLE_EQ(report.at("error"), estimated_relative_error(cold.image, cold.translucent));
  std::vector<std::string> stages;
  for (const Json& cost : report.at("costs")) stages.push_back(cost.at("stage"));
  EXPECT_EQ(stages,
            (std::vector<std::string>{"rays", "sampling", "irradiance", "diffusion", "bounces", "shading"}));
  EXPECT_EQ(page.texts.at("plan").at("groups").size(), 2u);
  EXPECT_GT(page.texts.at("schema").at("rows").size(), 50u);
  page.set({{"camera.field_of_view", 20}});
  ASSERT_TRUE(page.read_until([&] { return page.texts.at("report").at("revision") == 2; }));
  EXPECT_NE(page.texts.at("report").at("reused").dump().find("samples reused"), std::string::npos);
}

}  // namespace
}  // namespace opaline
