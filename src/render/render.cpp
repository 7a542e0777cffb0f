// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/render.h"

#include <algorithm>
#include <atomic>

#include "opaline/core/parallel.h"
#include "render/camera_rays.h"
#include "render/layers.h"
#include "render/shade.h"

namespace opaline {
namespace {

// Tiles lie on a fixed grid of the whole picture: a crop's pixels are those of the whole.
constexpr int kTile = 16;

struct Rectangle {
  int x0, y0, x1, y1;
};

Rectangle rendered_part(const Film& film) {
  if (film.crop) return {(*film.crop)[0], (*film.crop)[1], (*film.crop)[2], (*film.crop)[3]};
  return {0, 0, film.resolution[0], film.resolution[1]};
}

class TileRenderer {
 public:
  TileRenderer(const RenderInput& input, const CameraRays& camera, const Shader& shader, Image& image)
      : input_(input), camera_(camera), shader_(shader), image_(image) {}

  struct Counts {
    std::size_t queries = 0, non_finite = 0;
  };

  Counts render(const Rectangle& tile) const {
    const std::size_t pixels = std::size_t(tile.x1 - tile.x0) * std::size_t(tile.y1 - tile.y0);
    const int samples = input_.scene.film.samples_per_pixel;
    std::vector<PixelSample> sums, seen;  // once there is something to see
    std::vector<TracedRay> rays(pixels);
    std::vector<std::uint64_t> keys(pixels);
    Counts counts;
    for (int s = 0; s < samples; ++s) {
      std::size_t i = 0;
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x, ++i) {
          rays[i] = {camera_.ray(x, y, s), {}};
          keys[i] = (std::uint64_t(y) * std::uint64_t(image_.full_width) + std::uint64_t(x)) *
                        std::uint64_t(samples) +
                    std::uint64_t(s);
        }
      advance(input_.monitor, 1);
      input_.rays.intersect(rays);
      const auto is_hit = [](const TracedRay& traced) { return traced.hit.mesh != Hit::kMiss; };
      if (!shader_.has_visible_lights() && std::ranges::none_of(rays, is_hit)) continue;
      if (sums.empty()) {
        sums.resize(pixels);
        counts.queries += shader_.shade(rays, keys, sums);
      } else {
        seen.assign(pixels, PixelSample{});
        counts.queries += shader_.shade(rays, keys, seen);
        for (i = 0; i < pixels; ++i) add_sample(sums[i], seen[i]);
      }
    }
    if (sums.empty()) return counts;
    counts.non_finite = store(tile, sums, samples);
    return counts;
  }

 private:
  // Pixels without anything stay as they are: zero, and their memory untouched.
  std::size_t store(const Rectangle& tile, const std::vector<PixelSample>& sums, int samples) const {
    std::size_t i = 0, non_finite = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x, ++i)
        if (!sums[i].empty()) non_finite += store_pixel(sums[i], samples, pixel(x, y));
    return non_finite;
  }

  float* pixel(int x, int y) const {
    const std::size_t row = std::size_t(y - image_.crop_y), column = std::size_t(x - image_.crop_x);
    return image_.pixels.data() + (row * std::size_t(image_.width) + column) * PixelSample::kChannels;
  }

  const RenderInput& input_;
  const CameraRays& camera_;
  const Shader& shader_;
  Image& image_;
};

std::vector<Rectangle> tiles_of(const Rectangle& part) {
  std::vector<Rectangle> tiles;
  for (int y = part.y0 / kTile * kTile; y < part.y1; y += kTile)
    for (int x = part.x0 / kTile * kTile; x < part.x1; x += kTile)
      tiles.push_back({std::max(x, part.x0), std::max(y, part.y0), std::min(x + kTile, part.x1),
                       std::min(y + kTile, part.y1)});
  return tiles;
}

}  // namespace

RenderResult render(const RenderInput& input) {
  const Film& film = input.scene.film;
  const Rectangle part = rendered_part(film);
  RenderResult result;
  Image& image = result.image;
  image.width = part.x1 - part.x0;
  image.height = part.y1 - part.y0;
  image.crop_x = part.x0;
  image.crop_y = part.y0;
  image.full_width = film.resolution[0];
  image.full_height = film.resolution[1];
  image.channels = layer_names();
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * PixelSample::kChannels);

  const CameraRays camera(input.scene.camera, film, input.world.origin);
  const Shader shader(input);
  const TileRenderer renderer(input, camera, shader, image);
  const std::vector<Rectangle> tiles = tiles_of(part);
  if (input.monitor != nullptr)
    input.monitor->begin("shading", tiles.size() * std::size_t(film.samples_per_pixel));
  std::atomic<std::size_t> queries{0}, non_finite{0};
  parallel_chunks(tiles.size(), 1, [&](std::size_t begin, std::size_t, std::size_t) {
    const TileRenderer::Counts counts = renderer.render(tiles[begin]);
    queries += counts.queries;
    non_finite += counts.non_finite;
  });
  result.queries = queries;
  result.non_finite = non_finite;
  return result;
}

}  // namespace opaline
