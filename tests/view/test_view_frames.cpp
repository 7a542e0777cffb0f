// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of a scene whose values change: the slider's picture is that of `opaline render --frames`, and what frames share
// is not computed again.
#include "../cli/run_program.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "values/frame_name.h"
#include "view_page.h"

namespace opaline {
namespace {

using namespace test;

/// The scene of ViewFolder, whose left ball rises from frame 2 to frame 8.
struct FramesFolder : ViewFolder {
  FramesFolder() {
    std::string text = bytes_of(scene);
    const std::string still = "[-15, 10, 0]";
    text.replace(text.find(still), still.size(), R"({"keyed": {"2": [-15, 10, 0], "8": [-15, 22, 4]}})");
    const std::string setting = "\"light_samples\": 4";
    text.replace(text.find(setting), setting.size(), setting + ", \"method\": \"hierarchical\"");
    put_bytes(scene, text);
  }

  /// R G B A of a frame as bits of halves, by the program.
  std::vector<std::uint16_t> by_program(int frame, const std::vector<std::string>& edits = {}) const {
    std::vector<std::string> words{
        "render", scene, "-o", file("out.####.exr"), "--frames", std::to_string(frame)};
    for (const std::string& edit : edits) words.insert(words.end(), {"--set", edit});
    EXPECT_EQ(run_program(words).exit_code, 0);
    const std::string picture = with_frame(file("out.####.exr"), frame);
    const Image image = read_image(picture);
    std::filesystem::remove(picture);
    std::vector<std::uint16_t> bits;
    for (std::size_t p = 0; p < std::size_t(image.width) * std::size_t(image.height); ++p)
      for (const char* name : {"R", "G", "B", "A"}) {
        const auto c = std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
        bits.push_back(half(image.pixels[p * image.channels.size() + c]).bits());
      }
    return bits;
  }
};

// Claim: without --frames a scene's frames go from its first key to its last; a frame has the bits of `opaline render
// --frames`, also after edits and in any order of frames; going to one is no step of undo; the body that stays is not
// sampled again. Fails if: samples are placed anew in each frame, the reference frame is not gone through, or a change of
// the medium leaves the old samples.
TEST(ViewFrames, AreThoseOfRender) {
  const FramesFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  EXPECT_EQ(page.texts.at("scene").at("frames"), Json({2, 3, 4, 5, 6, 7, 8}));
  EXPECT_TRUE(page.frame.colours == folder.by_program(2));
  page.send({{"do", "frame"}, {"frame", 7}});
  ASSERT_TRUE(page.read_final(2));
  EXPECT_EQ(page.texts.at("scene").at("frame"), 7);
  const Json shapes = page.texts.at("scene").at("scene").at("shapes");
  EXPECT_NEAR(shapes.at(0).at("sphere").at("center").at(1).get<double>(), 20, 1e-9);
  EXPECT_FALSE(page.texts.at("scene").at("undo"));
  EXPECT_TRUE(page.frame.colours == folder.by_program(7));
  page.set({{"media.stone.specular_ior", 1.3}, {"media.stone.preset", "skin1"}});
  ASSERT_TRUE(page.read_final(3));
  const auto edits = page.texts.at("scene").at("edits").get<std::vector<std::string>>();
  EXPECT_TRUE(page.frame.colours == folder.by_program(7, edits));
  page.send({{"do", "frame"}, {"frame", 3}});
  ASSERT_TRUE(page.read_final(4));
  EXPECT_TRUE(page.frame.colours == folder.by_program(3, edits));
  ASSERT_TRUE(page.read_until(
      [&] { return page.texts.contains("report") && page.texts["report"]["revision"] == 4; }));
  EXPECT_NE(page.texts["report"].dump().find("samples moved with the surface"), std::string::npos)
      << page.texts["report"];
  page.send({{"do", "undo"}});
  ASSERT_TRUE(page.read_final(5));
  EXPECT_EQ(page.texts.at("scene").at("frame"), 3);
  EXPECT_TRUE(page.frame.colours == folder.by_program(3));
  page.send({{"do", "frame"}, {"frame", 9}});
  EXPECT_NE(page.read_answer().find("one from 2 to 8"), std::string::npos);
}

// Claim: --frames says which frames there are; without keys and without it there is no slider.
TEST(ViewFrames, AreChosen) {
  const FramesFolder folder;
  SceneEdits edits(folder.scene, {}, {1, 5, 20});
  EXPECT_EQ(edits.frame(), 1);
  edits.go_to_frame(20);
  EXPECT_EQ(edits.revision(), 2u);
  EXPECT_THROW(edits.go_to_frame(2), Error);
  EXPECT_EQ(std::get<SphereShape>(edits.scene().shapes[0].source).center.y, 22);
  EXPECT_EQ(std::get<SphereShape>(edits.reference()->shapes[0].source).center.y, 10);
  const ViewFolder still;
  SceneEdits none(still.scene, {});
  EXPECT_TRUE(none.frames().empty());
  EXPECT_FALSE(none.frame() || none.reference());
  EXPECT_THROW(none.go_to_frame(1), Error);
}

struct LongViewFrames : ::testing::Test {
  FramesFolder folder;
};

// Claim: the slider shows a frame, a server that comes back is brought to it.
TEST_F(LongViewFrames, TheSlider) {
  std::optional<RunningView> view(std::in_place, folder.scene);
  Browser browser;
  const Tab tab = browser.open(view->url());
  ASSERT_TRUE(browser.comes_true(tab, kIsFinal + "1"));
  EXPECT_EQ(browser.run(tab, "document.getElementById('frames').hidden"), false);
  browser.run(tab,
              "(() => { const s = document.getElementById('playhead'); s.value = 4; "
              "s.dispatchEvent(new Event('input')); })()");
  ASSERT_TRUE(browser.comes_true(tab, kIsFinal + "2"));
  EXPECT_EQ(browser.run(tab, "document.getElementById('shown-frame').textContent"), "6");
  const std::uint16_t port = view->port();
  view.reset();
  ASSERT_TRUE(browser.comes_true(tab, "!document.getElementById('lost').hidden"));
  view.emplace(folder.scene, port);
  ASSERT_TRUE(browser.comes_true(tab, "document.getElementById('lost').hidden"));
  ViewClient page(*view);
  ASSERT_TRUE(page.read_final(2));
  EXPECT_EQ(page.texts.at("scene").at("frame"), 6);
  ASSERT_TRUE(browser.comes_true(tab, "document.getElementById('shown-frame').textContent === '6'"));
  EXPECT_EQ(browser.run(tab, "document.getElementById('playhead').value"), "4");
}

}  // namespace
}  // namespace opaline
