// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/adaptive_rays.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "core/parallel.h"
#include "render/bounced_light.h"
#include "render/relative_noise.h"
#include "render/tile_renderer.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

// Round 0 has the first rays of a pixel, and each further round as many as all before.
constexpr int kFirstRays = kFewestAdaptiveRays / 2;

/// Variance, relative to the squared mean, by features between all rays of a pixel: n rays miss one with a probability, and one of an
/// area, of the order of 1 / n. Its error is at most the feature itself.
/// in    around: mean relative variance of the rays of the pixels around
double unseen_variance(double around, double n) {
  constexpr double kProbability = 1. / 8;  // beside the pixels along an edge
  const double missed = kFewestAdaptiveRays / n;
  return std::min(kProbability * missed * missed * around, 1.0) / n;
}

int rays_before(int round) {
  return round == 0 ? 0 : kFirstRays << (round - 1);
}

int rounds_of(int rays) {
  return rays == 0 ? 0 : std::bit_width(unsigned(rays / kFirstRays));
}

constexpr int kMostRounds = std::bit_width(unsigned(kMostAdaptiveRays / kFirstRays));

RgbF radiance_of(const PixelSample& sample) {
  return sample.diffuse + sample.specular + sample.emitted;
}

/// Rays of a pixel so far.
struct Pixel {
  PixelSample sum{};
  RgbF root{}, diffuse_root{};  ///< roots of the summed squares
  RgbF change{};  ///< half the difference of the last round from the rays before: a standard error
  int rounds = 0;

  int rays() const { return rays_before(rounds); }
  RgbF mean() const { return radiance_of(sum) * (1 / float(rays())); }
  /// Variance of the mean, for independent rays.
  double variance(std::size_t c) const { return variance(double(root[c]), double(radiance_of(sum)[c])); }
  double diffuse_variance(std::size_t c) const {
    return variance(double(diffuse_root[c]), double(sum.diffuse[c]));
  }
  bool has_surface() const { return sum.coverage > 0 || sum.shadow > 0; }
  bool is_lit() const { return !sum.empty() && is_finite(radiance_of(sum)); }

 private:
  double variance(double root_of_squares, double total) const {
    const double n = rays();
    return std::max(0.0, root_of_squares * root_of_squares - total * total / n) / (n * (n - 1));
  }
};

void add_squares(RgbF& root, const Rgb& squares) {
  for (std::size_t c = 0; c < 3; ++c)
    root[c] = float(std::sqrt(double(root[c]) * double(root[c]) + squares[c]));
}

/// Renders a sequence of rays of each pixel: rounds 0 and 1, or one later round.
class Sequence {
 public:
  static std::size_t of(int round) { return std::size_t(std::max(0, round - 1)); }

  Sequence(const RenderInput& input, std::size_t number)
      : number_(number),
        scene_(scene_of(input.scene, number)),
        input_(input_of(input, scene_)),
        shader_(input_),
        renderer_(input_, shader_, CameraSamples::progressive) {
    constexpr int kOfWidth = 16;  // equal in all rounds: further rays of a pixel converge to one image
    shader_.set_ray_width(kOfWidth);
  }
  Sequence(const Sequence&) = delete;
  Sequence& operator=(const Sequence&) = delete;

  const RenderInput& input() const { return input_; }
  Shader& shader() { return shader_; }
  std::size_t render(const Rectangle& tile, int round, std::span<const std::uint8_t> chosen,
                     const TileRenderer::UseSample& use) const {
    const auto before = std::uint64_t(number_ == 0 ? 0 : rays_before(round));
    return renderer_.render_progressive(
        tile, {.index = number_},
        {before, std::uint64_t(rays_before(round)) - before, std::uint64_t(rays_before(round + 1)) - before},
        chosen, use);
  }

 private:
  static Scene scene_of(const Scene& scene, std::size_t number) {
    constexpr int kShare = 16;  // a ray has at least this part of the light samples of a pixel
    Scene with_rays = scene;
    Settings& settings = with_rays.settings;
    const int rays = number == 0 ? kFewestAdaptiveRays : kFirstRays << number;
    with_rays.film.samples_per_pixel = rays;
    settings.light_samples =
        std::max(settings.light_samples, rays * ((settings.light_samples + kShare - 1) / kShare));
    return with_rays;
  }
  static RenderInput input_of(const RenderInput& input, const Scene& scene) {
    return {scene, input.world, input.rays, input.groups, input.monitor, nullptr, input.bounced};
  }

  std::size_t number_;
  Scene scene_;
  RenderInput input_;
  Shader shader_;
  TileRenderer renderer_;
};

/// Pixels by the binary logarithm of the decrease of their squared noise per ray, in equal steps.
class Gains {
 public:
  static constexpr int kSteps = 4;  // per factor of 2

  static std::optional<std::size_t> step(double variance, int rays) {
    if (!(variance > 0)) return {};
    const double place = std::log2(variance / rays) * kSteps + kCount / 2.;
    return std::size_t(std::clamp(place, 0., kCount - 1.));
  }
  void add(std::size_t step, double variance) { sums_[step] += variance; }
  /// For pixels without further rays.
  void add_fixed(double variance) { fixed_ += variance; }

  /// Least step of pixels to continue until the sum of variances is `aim`; each doubling of rays divides a
  /// variance by 2^1.5, as at edges. Noise needs more rounds.
  std::size_t least_step(double aim) const {
    std::size_t least = kCount;
    while (least > 0 && expected(least) > aim) --least;
    return least;
  }

 private:
  static constexpr std::size_t kCount = 512;

  double expected(std::size_t least) const {
    constexpr double kFall = 1.5;
    constexpr auto kStepsOfRound = std::size_t((1 + kFall) * kSteps);
    double sum = fixed_;
    for (std::size_t s = 0; s < kCount; ++s)
      sum += s < least ? sums_[s] : sums_[s] * std::exp2(-kFall * double(1 + (s - least) / kStepsOfRound));
    return sum;
  }

  std::array<double, kCount> sums_{};
  double fixed_ = 0;
};

class AdaptiveImage {
 public:
  explicit AdaptiveImage(const RenderInput& input)
      : input_(input),
        film_(input.scene.film),
        part_(rendered_part(film_)),
        width_(std::size_t(part_.x1 - part_.x0)),
        tiles_(tiles_of(film_)),
        pixels_(tiles_.size()),
        chosen_(tiles_.size()) {
    sequences_.push_back(std::make_unique<Sequence>(input, 0));
    if (bounces_of(input.scene) > 0) bounced_.emplace(sequences_[0]->input(), sequences_[0]->shader());
    if (bounced_) sequences_[0]->shader().set_bounced_light(&*bounced_);
  }

  /// The same numbers of rays as in an earlier image.
  AdaptiveRays repeat(std::span<const std::uint16_t> rays) {
    begin(std::accumulate(rays.begin(), rays.end(), std::size_t(0)));
    for (int round = 0; round < kMostRounds; ++round)
      continue_pixels(
          [&](std::size_t, std::size_t, std::size_t place) { return rounds_of(rays[place]) > round; });
    return {.rays = {}, .noise = estimate().value()};
  }

  /// Rounds until the error.
  AdaptiveRays refine(double until_error) {
    begin(2 * kFirstRays * width_ * std::size_t(part_.y1 - part_.y0));
    for (int round = 0; round < 2; ++round)
      continue_pixels([](std::size_t, std::size_t, std::size_t) { return true; });
    keep_borders();
    AdaptiveRays reached;
    while (true) {
      const RelativeNoise noise = estimate();
      reached.noise = noise.value();
      if (input_.monitor != nullptr) input_.monitor->noise = reached.noise;
      if (reached.noise <= until_error) break;
      if (!continue_worst(noise, until_error)) {
        reached.has_reached_most = true;
        break;
      }
    }
    return reached;
  }

  RenderResult result(AdaptiveRays adaptive) const {
    RenderResult result;
    const MethodLayers layers = method_of(input_.scene.settings.method).layers();
    result.image = empty_image(part_, film_, layer_names(layers));
    result.translucent.resize(width_ * std::size_t(part_.y1 - part_.y0));
    adaptive.rays.assign(result.translucent.size(), kFewestAdaptiveRays);
    const std::size_t channels = result.image.channels.size();
    const auto store = [&](bool with_antialiasing) {
      result.non_finite = 0;
      for_each([&](std::size_t tile, std::size_t, std::size_t place, const Pixel& pixel) {
        adaptive.rays[place] = std::uint16_t(pixel.rays());
        PixelSample sum = pixel.sum;
        if (sum.empty()) return;
        result.translucent[place] = 2 * sum.translucent > sum.coverage ? 1 : 0;
        if (with_antialiasing) sum.noise = noise_of(tile, pixel);
        result.non_finite +=
            store_pixel(sum, pixel.rays(), layers, result.image.pixels.data() + place * channels);
      });
    };
    store(false);
    if (layers.error) {
      adaptive.settings_error = estimated_relative_error(result.image, result.translucent);
      store(true);
    }
    result.adaptive = std::move(adaptive);
    result.queries = queries_;
    return result;
  }

 private:
  void begin(std::size_t rays) const {
    if (input_.monitor != nullptr) input_.monitor->begin("shading", rays);
  }

  /// Makes pixels of the empty tiles beside others: they may continue.
  void keep_borders() {
    const auto columns = std::size_t(std::ranges::count(tiles_, tiles_[0].y0, &Rectangle::y0));
    std::vector<bool> is_beside(tiles_.size());
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      if (pixels_[tile].empty()) continue;
      const std::size_t row = tile / columns, column = tile % columns;
      for (std::size_t r = row > 0 ? row - 1 : 0; r <= row + 1; ++r)
        for (std::size_t c = column > 0 ? column - 1 : 0; c < std::min(columns, column + 2); ++c)
          if (r * columns + c < tiles_.size()) is_beside[r * columns + c] = true;
    }
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
      if (is_beside[tile] && pixels_[tile].empty()) make_pixels(tile);
  }
  void make_pixels(std::size_t tile) {
    pixels_[tile].resize(chosen_[tile].size());
    for (Pixel& pixel : pixels_[tile]) pixel.rounds = rounds_of_empty_[tile];
  }

  /// Calls use(tile, index in the tile, place in the image, pixel) in a fixed order, without tiles of nothing.
  template <class Use>
  void for_each(const Use& use) const {
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
      if (!pixels_[tile].empty())
        for_each_pixel(tiles_[tile], part_,
                       [&](int x, int y, std::size_t i) { use(tile, i, place_of(x, y), pixels_[tile][i]); });
  }
  std::size_t place_of(int x, int y) const {
    return std::size_t(y - part_.y0) * width_ + std::size_t(x - part_.x0);
  }

  /// Renders the next round of each pixel with is_chosen(tile, index, place).
  template <class IsChosen>
  void continue_pixels(const IsChosen& is_chosen) {
    int last = 0;
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      chosen_[tile].assign(
          std::size_t(tiles_[tile].x1 - tiles_[tile].x0) * std::size_t(tiles_[tile].y1 - tiles_[tile].y0), 0);
      for_each_pixel(tiles_[tile], part_, [&](int x, int y, std::size_t i) {
        if (!is_chosen(tile, i, place_of(x, y))) return;
        const int round = pixels_[tile].empty() ? rounds_of_empty_[tile] : pixels_[tile][i].rounds;
        chosen_[tile][i] = std::uint8_t(1 + round);
        last = std::max(last, round);
      });
    }
    while (sequences_.size() <= Sequence::of(last)) {
      sequences_.push_back(std::make_unique<Sequence>(input_, sequences_.size()));
      if (bounced_) sequences_.back()->shader().set_bounced_light(&*bounced_);
    }
    std::atomic<std::size_t> queries{0};
    parallel_chunks(tiles_.size(), 1, [&](std::size_t tile, std::size_t, std::size_t) {
      for (int round = last; round >= 0; --round) queries += add_round(tile, round);
    });
    queries_ += queries;
  }

  /// Returns the number of queries.
  std::size_t add_round(std::size_t tile, int round) {
    std::vector<std::uint8_t> chosen(chosen_[tile].size());
    std::ranges::transform(chosen_[tile], chosen.begin(),
                           [&](std::uint8_t number) { return number == 1 + round ? 1 : 0; });
    if (std::ranges::none_of(chosen, [](std::uint8_t c) { return c != 0; })) return 0;
    std::vector<Pixel>& pixels = pixels_[tile];
    std::vector<RgbF> before;
    std::vector<Rgb> squares(chosen.size()), diffuse_squares(chosen.size());
    const auto start = [&] {
      if (pixels.empty()) make_pixels(tile);
      for (const Pixel& pixel : pixels) before.push_back(radiance_of(pixel.sum));
    };
    const std::size_t queries = sequences_[Sequence::of(round)]->render(
        tiles_[tile], round, chosen, [&](std::size_t i, const PixelSample& sample) {
          if (before.empty()) start();
          const Rgb radiance(radiance_of(sample)), diffuse(sample.diffuse);
          add_sample(pixels[i].sum, sample);
          squares[i] += radiance * radiance;
          diffuse_squares[i] += diffuse * diffuse;
        });
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (chosen[i] == 0) continue;
      if (before.empty()) start();
      ++pixels[i].rounds;
      add_squares(pixels[i].root, squares[i]);
      add_squares(pixels[i].diffuse_root, diffuse_squares[i]);
      if (round == 0) continue;
      const RgbF change = (radiance_of(pixels[i].sum) - before[i] * 2) * (1 / float(pixels[i].rays()));
      for (std::size_t c = 0; c < 3; ++c) pixels[i].change[c] = std::abs(change[c]);
    }
    if (pixels.empty()) ++rounds_of_empty_[tile];
    return queries;
  }

  /// Noise of the image, and the variances of its pixels over those of independent rays.
  RelativeNoise estimate() {
    std::array<double, 3> brightest = bright();
    RelativeNoise noise(brightest);
    std::vector<std::array<double, 3>> measured(tiles_.size()), independent(tiles_.size());
    for_each([&](std::size_t tile, std::size_t, std::size_t, const Pixel& pixel) {
      if (!pixel.is_lit()) return;
      const RgbF mean = pixel.mean();
      const Rgb change(pixel.change), squares = change * change;
      noise.add(mean, squares, pixel.has_surface());
      for (std::size_t c = 0; c < 3; ++c) {
        const double scale = noise.scale(c, double(mean[c]));
        if (!(scale > 0)) continue;
        measured[tile][c] += squares[c] / scale;
        independent[tile][c] += pixel.variance(c) / scale;
      }
    });
    factors_.assign(tiles_.size(), {});
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
      for (std::size_t c = 0; c < 3; ++c)
        if (independent[tile][c] > 0) factors_[tile][c] = measured[tile][c] / independent[tile][c];
    return noise;
  }

  /// Brightness of the image by channel: the 99th percentile of its lit pixels, below highlights.
  std::array<double, 3> bright() const {
    constexpr double kShare = .99;
    std::array<std::vector<float>, 3> values;
    for_each([&](std::size_t, std::size_t, std::size_t, const Pixel& pixel) {
      if (!pixel.is_lit() || !pixel.has_surface()) return;
      for (std::size_t c = 0; c < 3; ++c) values[c].push_back(pixel.mean()[c]);
    });
    std::array<double, 3> bright{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (values[c].empty()) continue;
      const auto place = values[c].begin() + std::ptrdiff_t(double(values[c].size() - 1) * kShare);
      std::ranges::nth_element(values[c], place);
      bright[c] = double(*place);
      if (!(bright[c] > 0)) bright[c] = double(*std::max_element(place, values[c].end()));
    }
    return bright;
  }

  /// Renders the next round of the pixels worth it; false: all of these have the most rays.
  bool continue_worst(const RelativeNoise& noise, double until_error) {
    constexpr double kMargin = .95;  // avoids rounds of few pixels
    const std::size_t channel = noise.worst_channel();
    std::vector<double> spread(width_ * std::size_t(part_.y1 - part_.y0));
    for_each([&](std::size_t, std::size_t, std::size_t place, const Pixel& pixel) {
      if (is_finite(pixel.mean())) spread[place] = pixel.variance(channel) * pixel.rays();
    });
    constexpr std::size_t kNone = ~std::size_t(0);
    std::vector<std::size_t> steps(spread.size(), kNone);
    Gains gains;
    for_each([&](std::size_t tile, std::size_t, std::size_t place, const Pixel& pixel) {
      if (!is_finite(pixel.mean())) return;
      const double n = pixel.rays(), scale = noise.scale(channel, double(pixel.mean()[channel]));
      if (!(scale > 0)) return;
      const double variance = factors_[tile][channel] * spread[place] / (n * scale) +
                              unseen_variance(around(spread, place) / scale, n);
      const std::optional<std::size_t> step = Gains::step(variance, pixel.rays());
      if (!step) return;
      if (pixel.rounds == kMostRounds) return gains.add_fixed(variance);
      gains.add(*step, variance);
      steps[place] = *step;
    });
    const double error = kMargin * until_error;
    const std::size_t least = gains.least_step(error * error * double(noise.lit()));
    const auto is_chosen = [&](std::size_t, std::size_t, std::size_t place) {
      return steps[place] != kNone && steps[place] >= least;
    };
    std::size_t rays = 0;
    for_each([&](std::size_t tile, std::size_t i, std::size_t place, const Pixel& pixel) {
      if (is_chosen(tile, i, place)) rays += std::size_t(pixel.rays());
    });
    if (rays == 0) return false;
    if (input_.monitor != nullptr) input_.monitor->total += rays;
    continue_pixels(is_chosen);
    return true;
  }

  /// Mean of the pixels around one.
  double around(const std::vector<double>& values, std::size_t place) const {
    const std::size_t x = place % width_, y = place / width_, height = values.size() / width_;
    double sum = 0;
    int count = 0;
    for (std::size_t row = y > 0 ? y - 1 : 0; row < std::min(y + 2, height); ++row)
      for (std::size_t column = x > 0 ? x - 1 : 0; column < std::min(x + 2, width_); ++column) {
        if (row == y && column == x) continue;
        sum += values[row * width_ + column];
        ++count;
      }
    return count > 0 ? sum / count : 0;
  }

  /// Variance of the sum of a pixel's diffuse radiance.
  Rgb noise_of(std::size_t tile, const Pixel& pixel) const {
    Rgb noise;
    const double n = pixel.rays();
    for (std::size_t c = 0; c < 3; ++c) noise[c] = factors_[tile][c] * pixel.diffuse_variance(c) * n * n;
    return noise;
  }

  const RenderInput& input_;
  const Film& film_;
  Rectangle part_;
  std::size_t width_;
  std::vector<Rectangle> tiles_;
  std::vector<std::vector<Pixel>> pixels_;  // by tile; empty: nothing was hit
  std::vector<int> rounds_of_empty_ = std::vector<int>(tiles_.size());
  std::vector<std::vector<std::uint8_t>> chosen_;  // by tile: 1 + the round to render, or 0
  std::vector<std::array<double, 3>> factors_;     // by tile: variance over the one of independent rays
  std::vector<std::unique_ptr<Sequence>> sequences_;
  std::optional<BouncedLight> bounced_;
  std::size_t queries_ = 0;
};

}  // namespace

bool has_adaptive_rays(const Scene& scene) {
  const Method method = scene.settings.method;
  return scene.settings.until_error && !scene.lights.empty() && method != Method::direct &&
         method != Method::volume;
}

std::size_t adaptive_bytes(const Film& film) {
  const Rectangle part = rendered_part(film);
  return std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0) *
         (sizeof(Pixel) + sizeof(std::uint16_t));
}

RenderResult render_adaptive(const RenderInput& input) {
  AdaptiveImage image(input);
  AdaptiveRays reached = input.adaptive_rays.empty() ? image.refine(*input.scene.settings.until_error)
                                                     : image.repeat(input.adaptive_rays);
  return image.result(std::move(reached));
}

}  // namespace opaline
