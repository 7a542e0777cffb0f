// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow rays of many points towards one light, traced together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/morton.h"
#include "core/random.h"
#include "geometry/ray_scene.h"
#include "irradiance/environment_shadows.h"
#include "lights/environment_sample.h"
#include "lights/light_tree.h"
#include "lights/shared_rays.h"
#include "transport/outer_boundary.h"

namespace opaline {

/// Points per batch of rays: enough for coherence, few enough for memory.
inline std::size_t batch_points(int light_samples) {
  return std::clamp<std::size_t>(16384 / std::size_t(light_samples), 1, 256);
}

/// Number of lights, from the first on, sharing their rays.
inline std::size_t sharing_rays(std::span<const Light> lights) {
  const auto other = std::find_if(lights.begin() + 1, lights.end(),
                                  [&](const Light& l) { return !share_rays(lights[0], l); });
  return std::size_t(other - lights.begin());
}

/// Shadow rays of a batch of points towards one light, or towards lights sharing their rays, with each ray's
/// unoccluded contribution.
class ShadowBatch {
 public:
  /// samples: rays per point; 1 for lights without an area. For ManyLights, each ray goes to one of them.
  ShadowBatch(const RayScene& rays, std::span<const Light> lights, const OuterBoundary& boundary, int samples,
              std::uint64_t seed)
      : rays_(rays),
        lights_(lights),
        boundary_(boundary),
        boundary_here_(boundary),
        samples_(is_delta(lights[0]) ? 1 : samples),
        seed_(seed),
        many_(std::get_if<ManyLights>(&lights[0].source)),
        environment_(std::get_if<EnvironmentLight>(&lights[0].source)),
        mean_transmitted_(boundary.transmittance(kMeanCosine)) {}
  ShadowBatch(const RayScene& rays, const Light& light, const OuterBoundary& boundary, int samples,
              std::uint64_t seed)
      : ShadowBatch(rays, std::span(&light, 1), boundary, samples, seed) {}

  /// Call for incoherent points: sorts their rays before tracing.
  void sort_rays() { scattered_ = samples_ == 1; }

  /// Call for coherent points: neighbours share the visibility of an environment.
  void share_shadows() { shares_shadows_ = true; }

  /// Call before directions() is needed.
  void keep_directions() { keeps_directions_ = true; }

  int samples() const { return samples_; }

  void reserve(std::size_t points) {
    carried_.reserve(points * std::size_t(samples_) * lights_.size());
    shadow_.reserve(points * std::size_t(samples_));
  }

  /// Adds all rays of one point; `index` chooses its rotation of the low-discrepancy points, `first` its
  /// start among them; `lobe` as in for_each_ray.
  void add(const SurfacePoint& point, std::uint64_t index, std::uint64_t first = 0,
           const Lobe* lobe = nullptr) {
    tilt_.reset();
    lift_.reset();
    if (boundary_.is_textured()) boundary_here_ = boundary_.at(point);
    std::array<double, 2> shift{};
    if (!is_delta(lights_[0]))
      shift = {unit_double(hash_bits(seed_, 2 * index)), unit_double(hash_bits(seed_, 2 * index + 1))};
    if (many_ != nullptr) return add_drawn(point, index, shift, first, lobe);
    if (environment_ != nullptr && lobe != nullptr) return add_mirrored(point, index, shift, first, *lobe);
    if (environment_ != nullptr && !keeps_directions_) return add_of_environment(point, index, shift, first);
    for (int s = 0; s < samples_; ++s) {
      const std::array<double, 2> square = r2_point(first + std::uint64_t(s), shift);
      std::array<float, 3> weights{};
      const LightSample sample =
          sample_lights(lights_, point.position, point.normal, square, samples_, weights);
      carry(point, sample, weights);
    }
  }

  /// Calls use(light, point in batch, sample, contribution, unoccluded contribution) for each ray in order,
  /// then discards them. Deterministic parts are split equally over samples of both halves, so the halves
  /// differ by their error only.
  template <class Use>
  void trace_lights(const Use& use) {
    if (scattered_ && shadow_.size() > kSorted)
      trace_sorted();
    else
      rays_.occluded(shadow_);
    std::size_t ray = 0;
    const std::size_t lights = lights_.size(), samples = std::size_t(samples_);
    for (std::size_t i = 0; i < carried_.size(); i += lights) {
      const std::span<const float> carried(&carried_[i], lights);
      const bool lit = std::ranges::any_of(carried, [](float c) { return c > 0; }) && shadow_[ray++].far >= 0;
      const std::size_t sample = i / lights, point = sample / samples, s = sample % samples;
      if (controls_.empty()) {
        for (std::size_t l = 0; l < lights; ++l) use(l, point, int(s), lit ? carried[l] : 0.0f, carried[l]);
        continue;
      }
      controls_[sample].lit = lit;
      if (many_ != nullptr && s + 1 == samples) use_controlled(point, use);
    }
    if (shares_shadows_ && pools_.size() >= kFewestPools && controls_.size() >= kFewestOfTogether)
      use_together(use);
    else
      for (std::size_t p = 0; p < pools_.size(); ++p) use_pool(pools_[p], end_of_pool(p), use);
    carried_.clear();
    controls_.clear();
    means_.clear();
    normals_.clear();
    pools_.clear();
    shadow_.clear();
    directions_.clear();
  }

  /// For one light: use(point in batch, sample, ...).
  template <class Use>
  void trace(const Use& use) {
    trace_lights([&](std::size_t, std::size_t p, int s, float e, float free) { use(p, s, e, free); });
  }

  /// Direction of a point's sample; valid during `use`.
  const Vec3f& direction(std::size_t point, int sample) const {
    return directions_[point * std::size_t(samples_) + std::size_t(sample)];
  }

 private:
  static constexpr std::size_t kSorted = 256;              // rays per Embree packet stream
  static constexpr float kMeanCosine = 2.0f / 3;           // mean cosine under uniform illumination
  static constexpr std::size_t kFewestOfEnvironment = 32;  // rays: a ratio of sums over fewer is biased
  // Minimum pools of neighbouring points, and rays of a pool, for a prediction of visibility.
  static constexpr std::size_t kFewestPools = 4, kFewestOfTogether = 256;
  static constexpr float kBeforeLight = 0.9999f;  // part of the way to the light
  static constexpr float kGrazing = 0.3f;         // cosine of steeper rays: always from the triangle
  static constexpr float kRounding = 1e-4f;       // rounding of a sum of a few floats, less one of them

  void carry(const SurfacePoint& point, const LightSample& sample, const std::array<float, 3>& weights) {
    const float cosine = dot(point.normal, sample.direction), height = dot(point.geometric, sample.direction);
    const bool is_lifted = cosine > 0 && height < kGrazing && is_lifted_at(point, height);
    const bool is_above = cosine > 0 && (height > 0 || is_lifted);
    const float transmitted = is_above ? boundary_here_.transmittance(std::min(cosine, 1.0f)) : 1.0f;
    bool is_carried = false;
    for (std::size_t l = 0; l < lights_.size(); ++l) {
      carried_.push_back(is_above && weights[l] > 0 ? weights[l] * cosine * transmitted : 0);
      is_carried |= carried_.back() > 0;
    }
    if (keeps_directions_) directions_.push_back(sample.direction);
    if (is_carried) {
      const Vec3f origin = point.position + point.geometric * rays_.offset(point);
      shadow_.push_back(is_lifted ? lifted_ray(origin, *lift_, sample)
                                  : Ray(origin, sample.direction, sample.distance * kBeforeLight));
    }
  }

  // True if a ray with this cosine to the geometric normal of the last point begins on the smooth surface
  // (README.md). Light passes through no other surface: the way from the point to the ray's origin is free.
  bool is_lifted_at(const SurfacePoint& point, float height) {
    if (!tilt_) tilt_ = rays_.tilt(point);
    if (height >= *tilt_) return false;
    if (!lift_) {
      lift_ = rays_.lift(point);
      const Vec3f offset = point.geometric * rays_.offset(point);
      Ray way(point.position + offset, *lift_ + offset, 1);
      if (*lift_ != Vec3f()) rays_.occluded({&way, 1});
      if (way.far < 0) lift_ = Vec3f();
    }
    return *lift_ != Vec3f();
  }

  // To the same point of the light as without the lift.
  static Ray lifted_ray(const Vec3f& origin, const Vec3f& lift, const LightSample& sample) {
    if (std::isinf(sample.distance)) return {origin + lift, sample.direction};
    return {origin + lift, sample.direction * sample.distance - lift, kBeforeLight};
  }

  // Neighbours in the order of a draw are similar: they alternate between the halves of a point's samples.
  void add_drawn(const SurfacePoint& point, std::uint64_t index, const std::array<double, 2>& shift,
                 std::uint64_t first, const Lobe* lobe) {
    constexpr double kGolden = 0.61803398874989484820;
    const LightTree& tree = *many_->tree;
    drawn_.resize(std::size_t(samples_));
    const std::uint64_t key = hash_bits(seed_, 2 * index);
    const double place = shift[0] + kGolden * double(first / std::uint64_t(samples_) % (1 << 20));
    const bool is_mirrored = lobe != nullptr && !tree.has_area();
    tree.draw({point.position, point.normal, is_mirrored ? lobe : nullptr}, place - std::floor(place), key,
              drawn_);
    for (int s = 0; s < samples_; ++s) {
      const int half = samples_ / 2;
      const LightTree::Drawn& draw = drawn_[std::size_t(s < half ? 2 * s + 1 : 2 * (s - half))];
      std::array<float, 3> weights{};
      LightSample sample;
      if (draw.expected > 0) {
        const std::array<double, 2> square{double(draw.rest), r2_point(first + std::uint64_t(s), shift)[1]};
        sample = sample_light(tree.lights()[draw.light], point.position, point.normal, square, 1);
        const RgbF colour = tree.colour(draw.light) * (sample.weight / draw.expected);
        for (std::size_t l = 0; l < lights_.size(); ++l) weights[l] = colour[channel(l)];
      }
      carry(point, sample, weights);
      if (samples_ > 1 && !keeps_directions_ && !tree.has_area()) control(draw);
    }
  }

  std::size_t channel(std::size_t light) const {
    return std::visit(
        [](const auto& kind) -> std::size_t {
          if constexpr (requires { kind.channel; }) return kind.channel.value_or(0);
          return 0;
        },
        lights_[light].source);
  }

  // Traces one of a few directions, sampled by the reflected light of the lobe, as the estimate of all.
  void add_mirrored(const SurfacePoint& point, std::uint64_t index, const std::array<double, 2>& shift,
                    std::uint64_t first, const Lobe& lobe) {
    constexpr float kEven = .1f;  // uniform part of the choice, for the different lobe of a grazing view
    constexpr std::size_t draws = kLobeDraws;
    std::array<std::array<double, 2>, draws> squares;
    std::array<EnvironmentSample, draws> drawn;
    std::array<float, draws> chances{};
    for (int s = 0; s < samples_; ++s) {
      const std::uint64_t number = first + std::uint64_t(s);
      for (std::size_t d = 0; d < draws; ++d) squares[d] = r2_point(number * draws + d, shift);
      sample_environment(*environment_, point.normal, squares, samples_ * kLobeDraws, drawn, &lobe);
      float sum = 0;
      for (std::size_t d = 0; d < draws; ++d) {
        const RgbF& w = drawn[d].weights;
        const float cosine = std::max(0.0f, dot(point.normal, drawn[d].direction));
        chances[d] = (w.x + w.y + w.z) * cosine * mirrored(lobe, dot(lobe.mirrored, drawn[d].direction));
        sum += chances[d];
      }
      const float even = kEven / float(draws);
      for (float& chance : chances) chance = sum > 0 ? (1 - kEven) * chance / sum + even : 1 / float(draws);
      float place = float(unit_double(hash_bits(seed_ + index, number)));
      std::size_t taken = 0;
      while (taken + 1 < draws && place >= chances[taken]) place -= chances[taken++];
      std::array<float, 3> weights{};
      for (std::size_t l = 0; l < lights_.size(); ++l)
        weights[l] = drawn[taken].weights[channel(l)] / chances[taken];
      carry(point, {drawn[taken].direction, std::numeric_limits<float>::infinity(), weights[0]}, weights);
    }
  }

  // Successive points sharing a sequence belong to one pixel, and form a pool.
  void add_of_environment(const SurfacePoint& point, std::uint64_t index, const std::array<double, 2>& shift,
                          std::uint64_t first) {
    if (pools_.empty() || index != pooled_) pools_.push_back(means_.size());
    pooled_ = index;
    means_.push_back(unshadowed(*environment_, point.normal));
    if (shares_shadows_) normals_.push_back(in_picture(*environment_, point.normal));
    std::array<std::array<double, 2>, kMostAtOnce> squares;
    std::array<EnvironmentSample, kMostAtOnce> drawn;
    for (std::size_t s = 0, count = 0; s < std::size_t(samples_); s += count) {
      count = std::min(kMostAtOnce, std::size_t(samples_) - s);
      for (std::size_t d = 0; d < count; ++d) squares[d] = r2_point(first + s + d, shift);
      sample_environment(*environment_, point.normal, std::span(squares).first(count), samples_, drawn);
      for (std::size_t d = 0; d < count; ++d) {
        std::array<float, 3> weights{};
        for (std::size_t l = 0; l < lights_.size(); ++l) weights[l] = drawn[d].weights[channel(l)];
        carry(point, {drawn[d].direction, std::numeric_limits<float>::infinity(), weights[0]}, weights);
        controls_.push_back({drawn[d].unshadowed, {}, 0, drawn[d].block, false});
      }
    }
  }

  void control(const LightTree::Drawn& draw) {
    controls_.push_back({draw.unshadowed * mean_transmitted_, draw.mean_unshadowed * mean_transmitted_,
                         draw.expected, 0, false});
  }

  // Control variate: the unshadowed sum of all lights is exact, so the shadow rays of the other samples
  // correct a sample. The mean is unchanged, because samples are independent.
  template <class Use>
  void use_controlled(std::size_t point, const Use& use) const {
    const std::size_t samples = std::size_t(samples_), first = point * samples, lights = lights_.size();
    const std::span<const Control> controls(&controls_[first], samples);
    RgbF lit, all;
    for (const Control& c : controls) {
      all += c.here;
      if (c.lit) lit += c.here;
    }
    for (std::size_t s = 0; s < samples; ++s) {
      const Control& c = controls[s];
      const float chance = std::sqrt(std::max(0.0f, 1 - c.expected));
      for (std::size_t l = 0; l < lights; ++l) {
        const std::size_t k = channel(l);
        const float carried = carried_[(first + s) * lights + l], here = c.here[k], others = all[k] - here;
        const float open = others > kRounding * all[k] ? (lit[k] - (c.lit ? here : 0)) / others : 0;
        const float drawn = (c.lit ? carried : 0) - open * here, sum = drawn + open * c.mean[k];
        const float half = .5f * (sum - chance * drawn), free = .5f * (carried + c.mean[k] - here);
        use(l, point, int(s), sum - half, free);
        use(l, point, s < samples / 2 ? samples_ - 1 : 0, half, free);
      }
    }
  }

  // Control variate: the unshadowed irradiance of an environment is exact. The rays of a pool estimate the
  // visible fraction per channel; the rays of a point add their difference from that estimate.
  template <class Use>
  void use_pool(std::size_t begin, std::size_t end, const Use& use) const {
    const std::size_t samples = std::size_t(samples_), lights = lights_.size();
    const bool is_known = (end - begin) * samples >= kFewestOfEnvironment;
    for (std::size_t l = 0; l < lights; ++l) {
      const std::size_t k = channel(l);
      float lit = 0, carried = 0, all = 0, mean = 0;
      for (std::size_t i = begin * samples; i < end * samples; ++i) {
        carried += carried_[i * lights + l];
        if (controls_[i].lit) lit += carried_[i * lights + l];
        all += controls_[i].here[k];
      }
      for (std::size_t p = begin; p < end; ++p) mean += means_[p][k];
      const bool is_controlled = is_known && all > 0;
      const float scale = is_controlled ? mean / all : 1, part = is_controlled ? lit / all : 0,
                  free = is_controlled ? carried / all : 0;
      for (std::size_t p = begin; p < end; ++p)
        for (std::size_t s = 0; s < samples; ++s) {
          const std::size_t i = p * samples + s;
          const float c = carried_[i * lights + l] * scale, here = controls_[i].here[k] * scale,
                      known = means_[p][k] / float(samples) - here;
          use(l, p, int(s), (controls_[i].lit ? c : 0) + part * known, c + free * known);
        }
    }
  }

  std::size_t end_of_pool(std::size_t p) const {
    return p + 1 < pools_.size() ? pools_[p + 1] : means_.size();
  }

  // Control variate by block: the rays of one half of the pixels, every other one, predict the light at the
  // other half, block by block of the environment; a pixel's own rays add their difference. Unbiased, as
  // predictions are independent of the pixel's rays. Negative results are clamped, and subtracted from
  // others.
  template <class Use>
  void use_together(const Use& use) const {
    const std::size_t samples = std::size_t(samples_), lights = lights_.size();
    EnvironmentShadows shadows(*environment_->picture);
    std::array<bool, 2> has_dark{};
    for (std::size_t p = 0; p < pools_.size(); ++p)
      for (std::size_t i = pools_[p] * samples; i < end_of_pool(p) * samples; ++i) {
        const std::span<const float> carried(&carried_[i * lights], lights);
        const bool is_traced = std::ranges::any_of(carried, [](float c) { return c > 0; });
        shadows.add(p % 2, controls_[i].block, controls_[i].lit);
        has_dark[p % 2] |= is_traced && !controls_[i].lit;
      }
    shadows.estimate(has_dark);
    std::vector<float> found(carried_.size()), of_pools(pools_.size() * lights), all(lights),
        positive(lights);
    for (std::size_t p = 0; p < pools_.size(); ++p)
      for (std::size_t point = pools_[p]; point < end_of_pool(p); ++point) {
        const RgbF expected = shadows.irradiance(p % 2, normals_[point]) * (1 / float(samples));
        for (std::size_t i = point * samples; i < (point + 1) * samples; ++i) {
          const float open = shadows.open(p % 2, controls_[i].block);
          for (std::size_t l = 0; l < lights; ++l) {
            const std::size_t k = channel(l), ray = i * lights + l;
            found[ray] = (controls_[i].lit ? carried_[ray] : 0) - open * controls_[i].here[k] + expected[k];
            of_pools[p * lights + l] += found[ray];
          }
        }
      }
    for (std::size_t i = 0; i < of_pools.size(); ++i) {
      all[i % lights] += of_pools[i];
      positive[i % lights] += std::max(0.0f, of_pools[i]);
    }
    for (std::size_t p = 0; p < pools_.size(); ++p)
      for (std::size_t i = pools_[p] * samples; i < end_of_pool(p) * samples; ++i)
        for (std::size_t l = 0; l < lights; ++l) {
          const std::size_t k = channel(l), ray = i * lights + l;
          const float scale = of_pools[p * lights + l] > 0 ? std::max(0.0f, all[l]) / positive[l] : 0;
          use(l, i / samples, int(i % samples), found[ray] * scale,
              carried_[ray] - controls_[i].here[k] + means_[i / samples][k] / float(samples));
        }
  }

  // Successive points may be incoherent; sorted rays trace in half the time.
  void trace_sorted() {
    constexpr float kCells = 1023;
    Vec3f low = shadow_[0].origin, high = low;
    for (const Ray& ray : shadow_) widen(low, high, ray.origin);
    const float side = max_component(high - low), scale = side > 0 ? kCells / side : 0;
    order_.resize(shadow_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Vec3f c = (shadow_[i].origin - low) * scale;
      order_[i] = morton_key(std::uint64_t(c.x), std::uint64_t(c.y), std::uint64_t(c.z)) << 32 | i;
    }
    std::ranges::sort(order_);
    sorted_.resize(shadow_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) sorted_[i] = shadow_[std::uint32_t(order_[i])];
    rays_.occluded(sorted_);
    for (std::size_t i = 0; i < order_.size(); ++i) shadow_[std::uint32_t(order_[i])].far = sorted_[i].far;
  }

  const RayScene& rays_;
  std::span<const Light> lights_;
  OuterBoundary boundary_, boundary_here_;  // the latter at the last point
  int samples_;
  std::uint64_t seed_;
  const ManyLights* many_;               // null: a single light
  const EnvironmentLight* environment_;  // null: another light
  float mean_transmitted_;               // approximate transmittance of the boundary
  std::vector<LightTree::Drawn> drawn_;
  bool scattered_ = false, keeps_directions_ = false, shares_shadows_ = false;
  // RayScene::tilt at the last point, and its lift, zero if blocked; none: not needed yet.
  std::optional<float> tilt_;
  std::optional<Vec3f> lift_;
  std::vector<float> carried_;
  /// One sample of many lights: its unoccluded contribution over its probability, and the mean of that over
  /// all draws of the sample.
  struct Control {
    RgbF here, mean;
    float expected;
    std::uint32_t block;  // block of an environment map
    bool lit;
  };
  std::vector<Control> controls_;   // empty: none
  std::vector<RgbF> means_;         // means of points lit by an environment
  std::vector<Vec3d> normals_;      // normals of these, in the space of the environment map
  std::vector<std::size_t> pools_;  // first point of each
  std::uint64_t pooled_ = 0;        // the last point's sequence
  std::vector<Vec3f> directions_;
  std::vector<Ray> shadow_, sorted_;
  std::vector<std::uint64_t> order_;
};

}  // namespace opaline
