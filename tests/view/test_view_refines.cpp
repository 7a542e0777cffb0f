// SPDX-License-Identifier: GPL-3.0-or-later
// Images of a change that takes seconds: the first one at once, then ever sharper ones.
#include <algorithm>

#include "view_client.h"

namespace opaline {
namespace {

using namespace test;

const char* const kDiffuse = R"({
  "media": {"stone": {"preset": "marble"}},
  "shapes": [{"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 10}, "reflectance": 0.5}],
  "lights": [{"type": "quad", "corner": [-20, 30, 20], "u": [40, 0, 0], "v": [0, 0, 40], "radiance": 5}],
  "camera": {"position": [0, 0, 60], "look_at": [0, 0, 0], "field_of_view": 24},
  "film": {"resolution": [32, 32]}
})";

std::string scene_in(const ScratchFolder& folder) {
  put_bytes(folder.file("a.json"), kDiffuse);
  return folder.file("a.json");
}

/// Frames of a revision up to the final one.
std::vector<Frame> frames_of(ViewClient& page, std::uint32_t revision) {
  std::vector<Frame> frames;
  while (frames.empty() || frames.back().step != PictureStep::final) {
    const std::size_t before = page.frames;
    if (!page.read_until([&] { return page.frames > before; })) break;
    if (page.frame.revision == revision) frames.push_back(page.frame);
  }
  return frames;
}

// Claim: an image that takes a while comes in ever more pixels. Fails if a coarser image follows a finer one, or if full
// size comes with the last one only.
TEST(ViewRefines, EachImageIsAtLeastAsFine) {
  const ScratchFolder folder;
  const RunningView view(scene_in(folder));
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  page.set({{"film.resolution", {320, 320}}, {"film.samples_per_pixel", 64}, {"settings.light_samples", 64}});
  const std::vector<Frame> frames = frames_of(page, 2);
  ASSERT_GE(frames.size(), 4u);
  // The first light is a coarse image enlarged to full size.
  for (std::size_t i = 2; i < frames.size(); ++i) EXPECT_GE(frames[i].width, frames[i - 1].width) << i;
  EXPECT_LT(frames[1].width, 320u);
  EXPECT_EQ(frames[frames.size() - 2].width, 320u);
}

// Claim: opaque shapes that become translucent show an image before their samples are there, whatever the last change
// took. Fails if the time of the last change of the kind alone decides.
TEST(ViewRefines, ANewBodyShowsItsFirstLight) {
  const ScratchFolder folder;
  const RunningView view(scene_in(folder));
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  page.set({{"shapes.ball.normals", "smooth"}});
  page.set({{"shapes.ball.visible", true}});  // a change of the kind that took nothing
  ASSERT_TRUE(page.read_final(2));
  page.set({{"shapes.ball.medium", "stone"}, {"settings.samples", 100000}});
  const std::vector<Frame> frames = frames_of(page, page.revision() + 1);
  ASSERT_GE(frames.size(), 2u);
  EXPECT_EQ(frames.front().step, PictureStep::moving);
}

}  // namespace
}  // namespace opaline
