// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/tile_renderer.h"

#include <algorithm>

namespace opaline {
namespace {

constexpr int kTile = 16;
constexpr std::uint64_t kBatchRays = 512;

// Rays of a batch: all samples of a square of pixels, or part of one pixel's samples if those are too many.
// Keeps rays coherent, and finishes a pixel at once.
struct Batch {
  Rectangle pixels;
  std::uint64_t first, end;  // samples
};

std::vector<Batch> batches_of(const Rectangle& tile, std::uint64_t samples) {
  int side = kTile;
  while (side > 1 && std::uint64_t(side * side) * samples > kBatchRays) side /= 2;
  std::vector<Batch> batches;
  for (int y = tile.y0; y < tile.y1; y += side)
    for (int x = tile.x0; x < tile.x1; x += side)
      for (std::uint64_t s = 0; s < samples; s += kBatchRays)
        batches.push_back({{x, y, std::min(x + side, tile.x1), std::min(y + side, tile.y1)},
                           s,
                           std::min(s + kBatchRays, samples)});
  return batches;
}

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
  image.pixel_aspect = film.pixel_aspect;
  image.full_height = film.resolution[1];
  image.channels = std::move(channels);
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * image.channels.size());
  return image;
}

TileRenderer::TileRenderer(const RenderInput& input, const Shader& shader, CameraSamples samples)
    : input_(input), camera_(input.scene, input.world), shader_(shader) {
  if (samples == CameraSamples::progressive) camera_.make_progressive(input.scene.settings.seed);
}

// Intersects the rays, or copies cached hits.
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
  intersect_from_camera(input_.scene, input_.rays, rays);
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
  const std::vector<Batch> batches = batches_of(tile, samples);
  if (held != nullptr) held->resize(batches.size());
  std::vector<PixelSample> seen;
  std::vector<TracedRay> rays;
  std::vector<std::uint64_t> keys;
  std::vector<std::size_t> pixel_of_ray;
  Tile result;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    HeldView::Batch* const kept = held != nullptr ? &(*held)[b] : nullptr;
    advance(input_.monitor, (b + 1) * samples / batches.size() - b * samples / batches.size());
    if (kept != nullptr && kept->is_traced && kept->hits.empty() && !shader_.has_visible_lights()) continue;
    rays.clear();
    keys.clear();
    pixel_of_ray.clear();
    for_each_pixel(tile, batches[b].pixels, [&](int x, int y, std::size_t pixel) {
      const std::uint64_t pixel_key = first_key + (std::uint64_t(y) * width + std::uint64_t(x)) * samples;
      for (std::uint64_t s = batches[b].first; s < batches[b].end; ++s) {
        rays.push_back({camera_.ray(x, y, int(s)), {}});
        keys.push_back(pixel_key + s);
        pixel_of_ray.push_back(pixel);
      }
    });
    trace(rays, kept);
    if (!shader_.has_visible_lights() && std::ranges::none_of(rays, is_hit)) continue;
    result.sums.resize(pixels);
    if (samples == 1) {
      result.queries += shader_.shade(shader_.camera_batch(rays, keys, result.sums), pass, kept).queries;
      continue;
    }
    seen.assign(rays.size(), PixelSample{});
    result.queries += shader_.shade(shader_.camera_batch(rays, keys, seen), pass, kept).queries;
    for (std::size_t i = 0; i < rays.size(); ++i) add_sample(result.sums[pixel_of_ray[i]], seen[i]);
  }
  return result;
}

std::size_t TileRenderer::render_progressive(const Rectangle& tile, const Pass& pass,
                                             const SequenceRange& range, std::span<const std::uint8_t> chosen,
                                             const UseSample& use) const {
  const Film& film = input_.scene.film;
  const auto samples = std::uint64_t(film.samples_per_pixel), width = std::uint64_t(film.resolution[0]);
  const std::uint64_t first_key = pass.index * width * std::uint64_t(film.resolution[1]) * samples;
  std::vector<PixelSample> seen;
  std::vector<TracedRay> rays;
  std::vector<std::uint64_t> keys;
  std::vector<std::size_t> pixel_of_ray;
  std::size_t queries = 0;
  const auto shade = [&] {
    trace(rays, nullptr);
    if (shader_.has_visible_lights() || std::ranges::any_of(rays, is_hit)) {
      seen.assign(rays.size(), PixelSample{});
      queries += shader_.shade(shader_.camera_batch(rays, keys, seen), pass).queries;
      for (std::size_t i = 0; i < rays.size(); ++i) use(pixel_of_ray[i], seen[i]);
    }
    advance(input_.monitor, rays.size());
    rays.clear();
    keys.clear();
    pixel_of_ray.clear();
  };
  // Pixels of several squares share a batch where few are chosen.
  for (const Batch& batch : batches_of(tile, range.end - range.begin)) {
    for_each_pixel(tile, batch.pixels, [&](int x, int y, std::size_t pixel) {
      if (chosen[pixel] == 0) return;
      if (!rays.empty() && rays.size() + (batch.end - batch.first) > kBatchRays) shade();
      const std::uint64_t pixel_key = first_key + (std::uint64_t(y) * width + std::uint64_t(x)) * samples;
      for (std::uint64_t s = range.begin + batch.first; s < range.begin + batch.end; ++s) {
        rays.push_back({camera_.ray(x, y, int(range.before + s)), {}});
        keys.push_back(pixel_key + s);
        pixel_of_ray.push_back(pixel);
      }
    });
  }
  if (!rays.empty()) shade();
  return queries;
}

}  // namespace opaline
