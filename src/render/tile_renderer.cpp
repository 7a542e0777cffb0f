// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/tile_renderer.h"

#include <algorithm>

namespace opaline {
namespace {

constexpr int kTile = 16;

bool is_hit(const TracedRay& traced) {
  return traced.hit.mesh != Hit::kMiss;
}

}  // namespace

Rectangle rendered_part(const Film& film) {
  if (film.crop) return {(*film.crop)[0], (*film.crop)[1], (*film.crop)[2], (*film.crop)[3]};
  return {0, 0, film.resolution[0], film.resolution[1]};
}

std::vector<Rectangle> tiles_of(const Film& film) {
  const Rectangle part = rendered_part(film);
  std::vector<Rectangle> tiles;
  for (int y = part.y0 / kTile * kTile; y < part.y1; y += kTile)
    for (int x = part.x0 / kTile * kTile; x < part.x1; x += kTile)
      tiles.push_back(
          {x, y, std::min(x + kTile, film.resolution[0]), std::min(y + kTile, film.resolution[1])});
  return tiles;
}

Rectangle common_part(const Rectangle& a, const Rectangle& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

Image empty_image(const Rectangle& part, const Film& film, std::vector<std::string> channels) {
  Image image;
  image.width = part.x1 - part.x0;
  image.height = part.y1 - part.y0;
  image.crop_x = part.x0;
  image.crop_y = part.y0;
  image.full_width = film.resolution[0];
  image.full_height = film.resolution[1];
  image.channels = std::move(channels);
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * image.channels.size());
  return image;
}

TileRenderer::TileRenderer(const RenderInput& input, const Shader& shader)
    : input_(input), camera_(input.scene.camera, input.scene.film, input.world), shader_(shader) {}

// Finds what the rays hit, or takes it from what is held.
void TileRenderer::trace(std::span<TracedRay> rays, HeldView::Batch* held) const {
  if (held != nullptr && held->is_traced) {
    for (std::size_t i = 0; i < held->hits.size(); ++i) {
      const HeldView::CameraHit& hit = held->hits[i];
      rays[i].ray.far = hit.far;
      rays[i].hit.mesh = hit.mesh;
      rays[i].hit.triangle = hit.triangle;
      rays[i].hit.u = hit.u;
      rays[i].hit.v = hit.v;
    }
    return;
  }
  input_.rays.intersect(rays);
  if (held == nullptr) return;
  if (std::ranges::any_of(rays, is_hit)) {
    held->hits.reserve(rays.size());
    for (const auto& [ray, hit] : rays) held->hits.push_back({hit.mesh, hit.triangle, hit.u, hit.v, ray.far});
  }
  held->is_traced = true;
}

TileRenderer::Tile TileRenderer::render(const Rectangle& tile, const Pass& pass,
                                        std::vector<HeldView::Batch>* held) const {
  const Film& film = input_.scene.film;
  const std::size_t pixels = std::size_t(tile.x1 - tile.x0) * std::size_t(tile.y1 - tile.y0);
  const auto samples = std::uint64_t(film.samples_per_pixel), width = std::uint64_t(film.resolution[0]);
  const std::uint64_t first_key = pass.index * width * std::uint64_t(film.resolution[1]) * samples;
  std::vector<PixelSample> seen;
  std::vector<TracedRay> rays(pixels);
  std::vector<std::uint64_t> keys(pixels);
  if (held != nullptr) held->resize(samples);
  Tile result;
  for (std::uint64_t s = 0; s < samples; ++s) {
    HeldView::Batch* const batch = held != nullptr ? &(*held)[s] : nullptr;
    advance(input_.monitor, 1);
    if (batch != nullptr && batch->is_traced && batch->hits.empty() && !shader_.has_visible_lights())
      continue;
    std::size_t i = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x, ++i) {
        rays[i] = {camera_.ray(x, y, int(s)), {}};
        keys[i] = first_key + (std::uint64_t(y) * width + std::uint64_t(x)) * samples + s;
      }
    trace(rays, batch);
    if (!shader_.has_visible_lights() && std::ranges::none_of(rays, is_hit)) continue;
    if (result.sums.empty()) {
      result.sums.resize(pixels);
      result.queries += shader_.shade(rays, keys, result.sums, pass, batch);
    } else {
      seen.assign(pixels, PixelSample{});
      result.queries += shader_.shade(rays, keys, seen, pass, batch);
      for (i = 0; i < pixels; ++i) add_sample(result.sums[i], seen[i]);
    }
  }
  return result;
}

}  // namespace opaline
