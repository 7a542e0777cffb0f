// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/irradiance/irradiance.h"

#include <cmath>
#include <numeric>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"
#include "opaline/diffusion/fresnel.h"
#include "opaline/irradiance/light_sampling.h"

namespace opaline {
namespace {

// Shadow rays of a batch of points towards one light, with what each carries if nothing blocks it.
class ShadowBatch {
 public:
  ShadowBatch(const RayScene& rays, const Light& light, double eta, int light_samples, std::uint64_t seed)
      : rays_(rays),
        light_(light),
        eta_(float(eta)),
        samples_(is_delta(light) ? 1 : light_samples),
        seed_(seed) {}

  int samples() const { return samples_; }

  void reserve(std::size_t points) {
    carried_.reserve(points * std::size_t(samples_));
    shadow_.reserve(points * std::size_t(samples_));
  }

  // Adds all rays of one point; `index` chooses its rotation of the low-discrepancy points.
  void add(const SurfacePoint& point, std::uint64_t index) {
    std::array<double, 2> shift{};
    if (!is_delta(light_))
      shift = {unit_double(hash_bits(seed_, 2 * index)), unit_double(hash_bits(seed_, 2 * index + 1))};
    for (int s = 0; s < samples_; ++s) {
      const LightSample sample =
          sample_light(light_, point.position, point.normal, r2_point(std::uint64_t(s), shift), samples_);
      const float cosine = dot(point.normal, sample.direction);
      float carried = 0;
      if (sample.weight > 0 && cosine > 0 && dot(point.geometric, sample.direction) > 0) {
        carried =
            sample.weight * cosine * (eta_ > 0 ? fresnel_transmittance(std::min(cosine, 1.0f), eta_) : 1.0f);
      }
      carried_.push_back(carried);
      if (carried > 0) {
        const Vec3f origin = point.position + point.geometric * rays_.offset(point);
        shadow_.push_back({origin, sample.direction, sample.distance * 0.9999f});
      }
    }
  }

  // Calls use(point in batch, sample, contribution) for each ray in order, then forgets them.
  template <class Use>
  void trace(const Use& use) {
    rays_.occluded(shadow_);
    std::size_t ray = 0;
    for (std::size_t i = 0; i < carried_.size(); ++i) {
      const bool lit = carried_[i] > 0 && shadow_[ray++].far >= 0;
      use(i / std::size_t(samples_), int(i % std::size_t(samples_)), lit ? carried_[i] : 0.0f);
    }
    carried_.clear();
    shadow_.clear();
  }

 private:
  const RayScene& rays_;
  const Light& light_;
  float eta_;
  int samples_;
  std::uint64_t seed_;
  std::vector<float> carried_;
  std::vector<Ray> shadow_;
};

// Points whose rays are traced at once: enough for coherent batches, few enough to bound their memory.
std::size_t batch_points(int light_samples) {
  return std::clamp<std::size_t>(16384 / std::size_t(light_samples), 1, 256);
}

struct ErrorSums {
  double variance = 0, sum = 0;
};

LightTransfer transfer_from(const IrradianceInput& input, const Light& light, std::uint64_t seed) {
  LightTransfer transfer;
  transfer.weights.resize(input.samples.size());
  const std::size_t batch_size = batch_points(input.light_samples);
  std::vector<ErrorSums> errors(chunk_count(input.samples.size(), batch_size));
  parallel_chunks(
      input.samples.size(), batch_size, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        ShadowBatch batch(input.rays, light, input.eta, input.light_samples, seed);
        batch.reserve(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
          const SurfaceSample& s = input.samples[i];
          batch.add(input.rays.surface_point(s.mesh, s.triangle, s.u, s.v), i);
        }
        // The first and the second half of the low-discrepancy points, each such a set itself, estimate the
        // error of their mean: its variance is (difference of the halves' means)^2 times n0 n1 / n^2.
        const int first_half = batch.samples() / 2;
        const double n0 = double(first_half), n1 = double(batch.samples() - first_half);
        const double weight0 = first_half > 0 ? std::sqrt(n1 / n0) : 0, weight1 = std::sqrt(n0 / n1);
        std::vector<std::array<double, 2>> halves(end - begin);
        batch.trace([&](std::size_t p, int s, float e) { halves[p][s < first_half ? 0 : 1] += double(e); });
        for (std::size_t p = 0; p < halves.size(); ++p) {
          const double sum = halves[p][0] + halves[p][1],
                       difference = weight0 * halves[p][0] - weight1 * halves[p][1];
          transfer.weights[begin + p] = float(sum);
          errors[chunk].variance += difference * difference;
          errors[chunk].sum += sum;
        }
        advance(input.monitor, end - begin);
      });
  if (is_delta(light) || input.light_samples < 2) return transfer;
  ErrorSums all;
  for (const ErrorSums& e : errors) {
    all.variance += e.variance;
    all.sum += e.sum;
  }
  const double n = double(input.samples.size());
  if (all.sum > 0) transfer.relative_error = std::sqrt(all.variance / n) / (all.sum / n);
  return transfer;
}

}  // namespace

std::vector<LightTransfer> compute_irradiance(const IrradianceInput& input) {
  if (input.monitor != nullptr)
    input.monitor->begin("irradiance", input.samples.size() * input.lights.size());
  std::vector<LightTransfer> transfers;
  for (std::size_t l = 0; l < input.lights.size(); ++l)
    transfers.push_back(transfer_from(input, input.lights[l], hash_bits(input.seed, l)));
  return transfers;
}

std::vector<RgbF> combine_lights(std::span<const LightTransfer> transfers, std::span<const Light> lights) {
  std::vector<RgbF> irradiance(transfers.empty() ? 0 : transfers[0].weights.size());
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const RgbF colour(emission(lights[l]));
    for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i] += colour * transfers[l].weights[i];
  }
  return irradiance;
}

double combined_noise(std::span<const LightTransfer> transfers, std::span<const Light> lights) {
  double squares = 0, sum = 0;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const auto& weights = transfers[l].weights;
    const double brought = max_component(emission(lights[l])) * std::accumulate(weights.begin(), weights.end(), 0.0);
    squares += std::pow(brought * transfers[l].relative_error, 2);
    sum += brought;
  }
  return sum > 0 ? std::sqrt(squares) / sum : 0;
}

std::vector<RgbF> irradiance_at(const PointIrradianceInput& input) {
  std::vector<RgbF> irradiance(input.points.size());
  for (std::size_t l = 0; l < input.lights.size(); ++l) {
    const RgbF colour(emission(input.lights[l]));
    ShadowBatch batch(input.rays, input.lights[l], input.eta, input.light_samples, hash_bits(input.seed, l));
    const std::size_t batch_size = batch_points(input.light_samples);
    batch.reserve(std::min(batch_size, input.points.size()));
    for (std::size_t begin = 0; begin < input.points.size(); begin += batch_size) {
      const std::size_t end = std::min(input.points.size(), begin + batch_size);
      for (std::size_t i = begin; i < end; ++i) batch.add(input.points[i], input.keys[i]);
      batch.trace([&](std::size_t p, int, float e) { irradiance[begin + p] += colour * e; });
    }
  }
  return irradiance;
}

}  // namespace opaline
