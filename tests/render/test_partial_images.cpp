// SPDX-License-Identifier: GPL-3.0-or-later
// Images in progress, for those who wait.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <mutex>

#include "../support/scenes.h"
#include "opaline/monitor.h"

namespace opaline::test {
namespace {

// Claim: each image in progress holds the finished pixels of the final image, and zeros; ever more are finished, those
// without a surface, too; one thread shows each tile, several may skip some. Source: monitor.h. Tolerance: none. Fails if a pixel
// is called final before it is stored.
void expect_finished_pixels(std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Scene scene = single_shape(SphereShape{{0, 0, 0}, 10}, marble(), 400);
  scene.lights = {point_light({0, 50, 100}, Rgb(1e4))};
  scene.film.resolution = {100, 70};
  scene.film.crop = {{10, 5, 97, 70}};
  scene.settings.method = Method::lambert;
  Session session;
  session.edit(scene);
  std::mutex mutex;
  std::vector<std::pair<Image, std::vector<std::uint8_t>>> partial;
  Monitor monitor;
  monitor.partial_interval = 0;
  monitor.show_partial = [&](Image&& image, const std::vector<std::uint8_t>& is_final) {
    const std::lock_guard lock(mutex);
    partial.emplace_back(std::move(image), is_final);
  };
  const Image final = session.render(&monitor).image;
  const std::size_t channels = final.channels.size();
  std::ptrdiff_t before = 0;
  for (const auto& [image, is_final] : partial) {
    ASSERT_EQ(image.pixels.size(), final.pixels.size());
    ASSERT_EQ(is_final.size() * channels, final.pixels.size());
    for (std::size_t i = 0; i < final.pixels.size(); ++i)
      ASSERT_EQ(image.pixels[i], is_final[i / channels] != 0 ? final.pixels[i] : 0);
    const std::ptrdiff_t finished = std::ranges::count(is_final, 1);
    EXPECT_GE(finished, before + (threads == 1 ? 1 : 0));
    before = finished;
  }
  if (threads > 1) return;
  EXPECT_GE(partial.size(), 3u);
  EXPECT_GT(before, std::ptrdiff_t(final.pixels.size() / channels / 2));
}

TEST(PartialImages, HoldFinishedPixels) {
  expect_finished_pixels(1);
  expect_finished_pixels(4);
}

}  // namespace
}  // namespace opaline::test
