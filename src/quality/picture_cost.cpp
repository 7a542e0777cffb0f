// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/picture_cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/stopwatch.h"
#include "opaline/compare.h"
#include "quality/probe.h"
#include "render/shade_parts.h"

namespace opaline {
namespace {

constexpr std::size_t kFewestTiles = 8, kFirstTiles = 24;
// Tiles up to this time, but no more than this fraction of the image.
constexpr double kTrySeconds = 0.02, kLeastLeft = 16;
constexpr double kOpaque = 0.3;  // shading cost of an opaque point over a translucent one, for sorting tiles

double pixels_of(const Rectangle& r) {
  return double(r.x1 - r.x0) * double(r.y1 - r.y0);
}

/// Waits for idle threads to stop spinning, so the kernel's accounting is complete.
void rest() {
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

/// Work in parts of an image, from a small version of it.
class Coverage {
 public:
  Coverage(const Film& film, const Image& probe)
      : probe_(probe),
        scale_x_(double(probe.full_width) / film.resolution[0]),
        scale_y_(double(probe.full_height) / film.resolution[1]),
        translucent_(translucent_pixels(probe)),
        seen_(extract_layer(probe, "A").channels.at(0)) {}

  double of(const Rectangle& part) const {
    const auto [x0, x1] = range(part.x0, part.x1, scale_x_, probe_.crop_x, probe_.width);
    const auto [y0, y1] = range(part.y0, part.y1, scale_y_, probe_.crop_y, probe_.height);
    double sum = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(probe_.width) + std::size_t(x);
        sum += translucent_[i] != 0 ? 1 : seen_[i] > 0 ? kOpaque : 0;
      }
    return sum / double((x1 - x0) * (y1 - y0));
  }

 private:
  static std::pair<int, int> range(int low, int high, double scale, int first, int count) {
    const int begin = std::clamp(int(low * scale) - first, 0, count - 1);
    return {begin, std::clamp(int(std::ceil(high * scale)) - first, begin + 1, count)};
  }

  const Image& probe_;
  double scale_x_, scale_y_;
  std::vector<std::uint8_t> translucent_;
  std::vector<float> seen_;
};

}  // namespace

ShadingCost::ShadingCost(const Scene& scene, const Image& probe) : tried_(kFirstTiles) {
  const Rectangle part = rendered_part(scene.film);
  const Coverage coverage(scene.film, probe);
  for (const Rectangle& tile : tiles_of(scene.film))
    tiles_.push_back({coverage.of(tile), common_part(tile, part)});
  std::ranges::stable_sort(tiles_, {}, &Tile::coverage);
}

double ShadingCost::of(const SettingsSearch& search) {
  const Session& session = search.session;
  RenderInput input{search.scene, session.world(), session.rays(), session.bodies()};
  input.bounced = search.bounced;
  const auto cost_of = [&](const std::vector<Rectangle>& parts) {
    rest();
    const Stopwatch watch;
    shade_parts(input, parts);
    rest();
    return watch.cost({}).cpu_seconds;
  };
  const std::size_t count = std::min(tried_, tiles_.size());
  std::vector<Rectangle> parts;
  double pixels = 0, all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Tile& tile = tiles_[(2 * i + 1) * tiles_.size() / (2 * count)];
    parts.push_back(tile.pixels);
    pixels += pixels_of(tile.pixels);
  }
  for (const Tile& tile : tiles_) all += pixels_of(tile.pixels);
  // Cost of an image before its first pixel.
  const double before = cost_of({}), tried = std::max(0.0, cost_of(parts) - before);
  const double most = double(tiles_.size()) / kLeastLeft;
  tried_ = std::size_t(std::clamp(double(count) * kTrySeconds / std::max(tried, 1e-4), double(kFewestTiles),
                                  std::max(most, double(kFewestTiles))));
  return before + tried * all / pixels;
}

Image thinned(const Image& picture, double pixels) {
  const double all = double(picture.width) * double(picture.height);
  const int step = std::max(1, int(std::sqrt(all / pixels)));
  Image small = picture;
  small.width = (picture.width + step - 1) / step;
  small.height = (picture.height + step - 1) / step;
  small.crop_x = small.crop_y = 0;
  small.full_width = small.width;
  small.full_height = small.height;
  const std::size_t channels = picture.channels.size();
  float* to = small.pixels.data();
  for (int y = 0; y < picture.height; y += step)
    for (int x = 0; x < picture.width; x += step)
      to = std::copy_n(
          picture.pixels.data() + (std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) * channels,
          channels, to);
  small.pixels.resize(std::size_t(small.width) * std::size_t(small.height) * channels);
  return small;
}

double finishing_cost(const Image& probe, const Film& film, const FinishPicture& finish) {
  Image corner = probe;
  corner.width = corner.height = std::min({probe.width, probe.height, 8});
  corner.pixels.resize(std::size_t(corner.width) * std::size_t(corner.height) * probe.channels.size());
  const auto cost_of = [&](const Image& image) {
    const Stopwatch watch;
    finish(image);
    return watch.cost({}).cpu_seconds;
  };
  cost_of(corner);
  const auto pixels = [](const Image& image) { return double(image.width) * double(image.height); };
  const double least = cost_of(corner), more = std::max(0.0, cost_of(probe) - least);
  const double each = more / std::max(1.0, pixels(probe) - pixels(corner));
  return least + each * pixels_of(rendered_part(film));
}

}  // namespace opaline
