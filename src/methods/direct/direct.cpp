// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/direct/direct.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"
#include "core/random.h"
#include "diffusion/diffuse_profile.h"
#include "methods/direct/direct_field.h"
#include "render/relative_noise.h"
#include "render/tile_renderer.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

constexpr std::size_t kEntrySamples = 16;  // per pixel and pass
constexpr std::size_t kFewestPasses = 8;   // before an estimate of the error is believed

int entry_samples_per_ray(const Film& film) {
  return std::max(1, int(kEntrySamples) / film.samples_per_pixel);
}

std::size_t most_passes(const Settings& settings, const Film& film) {
  constexpr std::size_t kWithoutEnd = std::size_t(1) << 32;
  const std::size_t samples =
      settings.entry_samples.value_or(settings.until_error ? kWithoutEnd : kDefaultEntrySamples);
  const std::size_t per_pass = entry_samples_per_pass(film);
  return (samples + per_pass - 1) / per_pass;
}

/// In random order, so that all parts have about as many pixels with an object.
std::vector<Rectangle> tiles_of_part(const Film& film, const ImagePart& part) {
  const std::vector<Rectangle> tiles = tiles_of(film);
  std::vector<std::size_t> order(tiles.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::sort(order, {}, [](std::size_t tile) { return hash_bits(0, tile); });
  std::vector<Rectangle> own;
  for (std::size_t i = part.number - 1; i < order.size(); i += part.count) own.push_back(tiles[order[i]]);
  return own;
}

std::size_t pixel_number(const Rectangle& part, int x, int y) {
  return std::size_t(y - part.y0) * std::size_t(part.x1 - part.x0) + std::size_t(x - part.x0);
}

class DirectRenderer {
 public:
  DirectRenderer(const PrecomputeInput& input, std::vector<Rectangle> tiles)
      : scene_(input.scene),
        render_input_{input.scene, input.world, input.rays, {}, input.monitor},
        samplers_(make_samplers(input)),
        sources_(make_sources(samplers_)),
        shader_(render_input_, sources_),
        tile_renderer_(render_input_, shader_),
        part_(rendered_part(input.scene.film)),
        tiles_(std::move(tiles)) {}

  std::size_t pixels() const { return std::size_t(part_.x1 - part_.x0) * std::size_t(part_.y1 - part_.y0); }
  std::size_t work_per_pass() const { return tiles_.size() * std::size_t(scene_.film.samples_per_pixel); }

  void add_pass(DirectState& state) const {
    const int samples = scene_.film.samples_per_pixel;
    const Pass pass = pass_of(state);
    std::vector<RgbF> radiance(pixels());
    for_each_tile(pass, [&](std::size_t pixel, const PixelSample& sum) {
      radiance[pixel] = sum.diffuse * (1 / float(samples));
    });
    for (std::size_t p = 0; p < radiance.size(); ++p) {
      if (radiance[p] == RgbF{}) continue;
      float* sums = state.sums.data() + p * DirectState::kSums;
      for (std::size_t c = 0; c < 3; ++c) {
        sums[c] += radiance[p][c];
        const double root = double(sums[c + 3]), value = double(radiance[p][c]);
        sums[c + 3] = float(std::sqrt(root * root + value * value));
      }
    }
    ++state.passes;
  }

  // All layers. Those other than the diffuse one need extra rays, which sample entry points only in specular
  // reflections.
  RenderResult picture(const DirectState& state) const {
    RenderResult result;
    const MethodLayers layers = method_of(Method::direct).layers();
    result.image = empty_image(part_, scene_.film, layer_names(layers));
    std::atomic<std::size_t> queries{0}, non_finite{0};
    const Pass mirrored = pass_of(state);
    // Fibres also reflect light from other surfaces.
    const bool has_fuzz = std::ranges::any_of(
        scene_.shapes, [&](const Shape& shape) { return has_bright_fuzz(scene_, shape); });
    const Pass first{.gathers = has_fuzz ? mirrored.gathers : nullptr, .in_mirrors = &mirrored};
    for_each_tile(first, [&](std::size_t pixel, PixelSample sum) {
      if (sum.empty()) return;
      // Variance of the sum, as if each sample had its mean irradiance; images of the irradiance contain the
      // variance.
      const auto samples = float(scene_.film.samples_per_pixel);
      const DirectEstimate passes = direct_estimate(state, pixel);
      sum.diffuse = passes.mean * samples;
      sum.irradiance = RgbF(passes.variance) * sum.coverage;
      non_finite += store_pixel(sum, scene_.film.samples_per_pixel, layers,
                                result.image.pixels.data() + pixel * result.image.channels.size());
      ++queries;
    });
    result.queries = queries;
    result.non_finite = non_finite;
    return result;
  }

 private:
  static std::vector<EntrySampler> make_samplers(const PrecomputeInput& input) {
    std::vector<EntrySampler> samplers;
    for (const BodyPlan& group : input.plan.groups)
      samplers.emplace_back(group, make_diffuse_profile(input.scene.media[group.medium], input.world.unit),
                            input.rays, input.world.diagonal, input.scene.settings.laboratory.entry_strategy);
    return samplers;
  }

  static std::vector<FieldSource> make_sources(std::span<const EntrySampler> samplers) {
    std::vector<FieldSource> sources;
    for (const EntrySampler& sampler : samplers)
      sources.push_back(
          {sampler.meshes(), [&sampler](const SurfaceTextures& textures, const OuterBoundary& boundary) {
             return std::make_unique<DirectField>(sampler, textures, boundary);
           }});
    return sources;
  }

  Pass pass_of(const DirectState& state) const {
    return {.index = state.passes,
            .entry_samples = entry_samples_per_ray(scene_.film),
            .gathers = bounces_of(scene_) > 0 ? &shader_ : nullptr};
  }

  template <class Use>
  void for_each_tile(const Pass& pass, const Use& use) const {
    parallel_chunks(tiles_.size(), 1, [&](std::size_t begin, std::size_t, std::size_t) {
      const Rectangle& tile = tiles_[begin];
      const TileRenderer::Tile rendered = tile_renderer_.render(tile, pass);
      if (rendered.sums.empty()) return;
      for_each_pixel(tile, part_,
                     [&](int x, int y, std::size_t i) { use(pixel_number(part_, x, y), rendered.sums[i]); });
    });
  }

  const Scene& scene_;
  RenderInput render_input_;
  std::vector<EntrySampler> samplers_;
  std::vector<FieldSource> sources_;
  Shader shader_;
  TileRenderer tile_renderer_;
  Rectangle part_;
  std::vector<Rectangle> tiles_;
};

}  // namespace

std::size_t entry_samples_per_pass(const Film& film) {
  return std::size_t(entry_samples_per_ray(film)) * std::size_t(film.samples_per_pixel);
}

DirectEstimate direct_estimate(const DirectState& state, std::size_t pixel) {
  DirectEstimate result;
  const float* sums = state.sums.data() + pixel * DirectState::kSums;
  const double n = double(state.passes);
  for (std::size_t c = 0; c < 3; ++c) {
    const double mean = double(sums[c]) / n, root = double(sums[c + 3]);
    result.mean[c] = float(mean);
    if (state.passes > 1) result.variance[c] = std::max(0.0, root * root / n - mean * mean) / (n - 1);
  }
  return result;
}

double relative_noise(const DirectState& state) {
  if (state.passes < 2) return std::numeric_limits<double>::infinity();
  const std::size_t pixels = state.sums.size() / DirectState::kSums;
  std::array<double, 3> brightest{};
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t c = 0; c < 3; ++c)
      brightest[c] = std::max(brightest[c], double(direct_estimate(state, p).mean[c]));
  RelativeNoise noise(brightest);
  for (std::size_t p = 0; p < pixels; ++p) {
    const DirectEstimate pixel = direct_estimate(state, p);
    if (pixel.mean != RgbF{}) noise.add(pixel.mean, pixel.variance);
  }
  return noise.value();
}

DirectResult render_direct(const PrecomputeInput& input, DirectState& state,
                           const std::function<void(const DirectState&)>& after_pass) {
  const DirectRenderer renderer(input, tiles_of(input.scene.film));
  const Settings& settings = input.scene.settings;
  state.sums.resize(renderer.pixels() * DirectState::kSums);
  const std::size_t passes = most_passes(settings, input.scene.film);
  const std::size_t first = state.passes;
  // Renders the other layers in one more pass.
  const auto expect = [&](std::size_t all) {
    if (input.monitor != nullptr)
      input.monitor->total = (std::max(all, state.passes) - first + 1) * renderer.work_per_pass();
  };
  // Noise falls with the root of the number of passes; the first few passes give no reliable estimate.
  bool good_enough = false;
  const auto look = [&] {
    if (!settings.until_error) return expect(passes);
    if (state.passes < kFewestPasses) return;
    const double noise = relative_noise(state), ratio = noise / *settings.until_error;
    good_enough = noise <= *settings.until_error;
    if (input.monitor != nullptr) input.monitor->noise = noise;
    expect(std::size_t(std::ceil(std::min(double(passes), double(state.passes) * ratio * ratio))));
  };
  if (input.monitor != nullptr) input.monitor->begin("shading", 0);
  look();
  while (state.passes < passes && !good_enough) {
    renderer.add_pass(state);
    look();
    if (after_pass) after_pass(state);
  }
  DirectResult result;
  result.picture = renderer.picture(state);
  result.entry_samples = state.passes * entry_samples_per_pass(input.scene.film);
  result.relative_error = relative_noise(state);
  return result;
}

void add_direct_passes(const PrecomputeInput& input, const ImagePart& part, DirectState& state,
                       const std::function<void(const DirectState&)>& after_pass) {
  const DirectRenderer renderer(input, tiles_of_part(input.scene.film, part));
  state.sums.resize(renderer.pixels() * DirectState::kSums);
  const std::size_t passes = most_passes(input.scene.settings, input.scene.film);
  if (input.monitor != nullptr)
    input.monitor->begin("shading", (passes - std::min(passes, state.passes)) * renderer.work_per_pass());
  while (state.passes < passes) {
    renderer.add_pass(state);
    if (after_pass) after_pass(state);
  }
}

std::size_t direct_tiles(const Film& film) {
  return tiles_of(film).size();
}

std::vector<std::size_t> pixels_of_part(const Film& film, const ImagePart& part) {
  const Rectangle whole = rendered_part(film);
  std::vector<std::size_t> pixels;
  for (const Rectangle& tile : tiles_of_part(film, part))
    for_each_pixel(tile, whole,
                   [&](int x, int y, std::size_t) { pixels.push_back(pixel_number(whole, x, y)); });
  return pixels;
}

}  // namespace opaline
