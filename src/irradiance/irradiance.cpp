// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/irradiance.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/parallel.h"
#include "irradiance/sample_key.h"
#include "irradiance/shadow_batch.h"
#include "irradiance/shadow_edges.h"
#include "lights/light.h"

namespace opaline {
namespace {

// Error estimate from the two halves of the low-discrepancy points, each low-discrepancy itself: the standard
// error of the mean is the difference of the halves' means times sqrt(n0 n1) / n.
class Halves {
 public:
  explicit Halves(int samples) : first_(samples / 2) {
    const double n0 = double(first_), n1 = double(samples - first_);
    weight0_ = first_ > 0 ? std::sqrt(n1 / n0) : 0;
    weight1_ = std::sqrt(n0 / n1);
  }
  std::size_t of(int sample) const { return sample < first_ ? 0 : 1; }
  double deviation(const std::array<double, 2>& sums) const {
    return std::abs(weight0_ * sums[0] - weight1_ * sums[1]);
  }

 private:
  int first_;
  double weight0_, weight1_;
};

// Calibrates the error from halves. Half of the rays are less evenly distributed than all, by a factor
// depending on their number and the light, and a single ray has no halves. With successive points close
// together, the deviation from the nearer of two neighbours is at least the noise: the halves' errors are
// scaled down to it in total, never up.
void fit_to_neighbours(const std::vector<float>& weights, bool single, std::vector<float>& deviations) {
  const std::size_t n = weights.size();
  if (n < 3) return;
  // Means for a normal distribution: the smaller of two differences, and the absolute value.
  constexpr double kLesser = 0.71, kAbsolute = 0.80;
  double neighbours = 0, halves = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const float before = weights[i > 0 ? i - 1 : i + 2], after = weights[i + 1 < n ? i + 1 : i - 2];
    const float lesser = std::min(std::abs(weights[i] - before), std::abs(weights[i] - after));
    if (single) deviations[i] = lesser;  // typically all light or none
    neighbours += double(lesser) / kLesser;
    halves += double(deviations[i]) / kAbsolute;
  }
  if (single || !(halves > neighbours)) return;
  const float scale = float(neighbours / halves);
  for (float& deviation : deviations) deviation *= scale;
}

struct ErrorSums {
  double variance = 0, sum = 0;
};

// Traces lights sharing their rays; unblocked: weights without occlusion.
void trace_transfers(const IrradianceInput& input, std::span<const Light> lights,
                     std::span<LightTransfer> transfers, std::span<std::vector<float>> unblocked) {
  const std::size_t n = input.samples.size();
  for (std::size_t l = 0; l < lights.size(); ++l) {
    transfers[l].weights.resize(n);
    unblocked[l].resize(n);
  }
  // Batch size for single rays: enough points for coherence.
  constexpr std::size_t kSinglePoints = 4096;
  const std::size_t batch_size = is_delta(lights[0]) ? kSinglePoints : batch_points(input.light_samples);
  std::vector<std::vector<ErrorSums>> errors(lights.size(),
                                             std::vector<ErrorSums>(chunk_count(n, batch_size)));
  parallel_chunks(n, batch_size, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    ShadowBatch batch(input.rays, lights, input.boundary, shadow_rays(lights[0], input.light_samples),
                      light_seed(input.seed, lights[0]));
    batch.sort_rays();
    batch.reserve(end - begin);
    std::vector<float> factors;
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceSample& s = input.samples[i];
      SurfacePoint point = input.rays.surface_point(s.mesh, s.triangle, s.u, s.v);
      point.width = std::sqrt(s.area);
      factors.push_back(enter_at(input, point));
      batch.add(point, i);
    }
    const Halves halves(batch.samples());
    std::vector<std::vector<std::array<double, 2>>> sums(lights.size(),
                                                         std::vector<std::array<double, 2>>(end - begin));
    batch.trace_lights([&](std::size_t l, std::size_t p, int s, float e, float free) {
      sums[l][p][halves.of(s)] += double(e * factors[p]);
      unblocked[l][begin + p] += free * factors[p];
    });
    for (std::size_t l = 0; l < lights.size(); ++l)
      for (std::size_t p = 0; p < end - begin; ++p) {
        const double sum = sums[l][p][0] + sums[l][p][1], deviation = halves.deviation(sums[l][p]);
        transfers[l].weights[begin + p] = float(sum);
        errors[l][chunk].variance += deviation * deviation;
        errors[l][chunk].sum += sum;
      }
    advance(input.monitor, (end - begin) * lights.size());
  });
  if (shadow_rays(lights[0], input.light_samples) < 2) return;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    ErrorSums all;
    for (const ErrorSums& e : errors[l]) {
      all.variance += e.variance;
      all.sum += e.sum;
    }
    if (all.sum > 0)
      transfers[l].relative_error = std::sqrt(all.variance / double(n)) / (all.sum / double(n));
  }
}

}  // namespace

std::vector<LightTransfer> compute_irradiance(const IrradianceInput& input) {
  if (input.monitor != nullptr)
    input.monitor->begin("irradiance", input.samples.size() * input.lights.size());
  std::vector<LightTransfer> transfers(input.lights.size());
  std::vector<std::vector<float>> unblocked(input.lights.size());
  for (std::size_t l = 0, count = 0; l < input.lights.size(); l += count) {
    count = sharing_rays(input.lights.subspan(l));
    trace_transfers(input, input.lights.subspan(l, count), std::span(transfers).subspan(l, count),
                    std::span(unblocked).subspan(l, count));
  }
  refine_shadow_edges(input, unblocked, transfers);
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

namespace {

void add_point(const PointIrradianceInput& input, std::size_t i, ShadowBatch& batch,
               const Lobe* lobe = nullptr) {
  const auto [shift, part] = part_of(input.keys[i]);
  batch.add(input.points[i], shift, part * std::uint64_t(batch.samples()), lobe);
}

// To lights sharing their rays.
std::vector<PointTransfers> transfers_to(const PointIrradianceInput& input, std::span<const Light> lights) {
  const std::size_t n = input.points.size(), batch_size = batch_points(input.light_samples);
  std::vector<PointTransfers> transfers(lights.size());
  for (PointTransfers& t : transfers) {
    t.weights.resize(n);
    if (!input.variance.empty()) t.deviations.resize(n);
  }
  ShadowBatch batch(input.rays, lights, input.boundary, shadow_rays(lights[0], input.light_samples),
                    light_seed(input.seed, lights[0]));
  if (input.is_together) batch.share_shadows();
  const Halves halves(batch.samples());
  std::vector<std::array<double, 2>> sums;  // by halves of a point's rays, and by light
  std::vector<RgbF> colours;
  for (const Light& light : lights) colours.emplace_back(emission(light));
  batch.reserve(std::min(batch_size, n));
  for (std::size_t begin = 0, count = 0; begin < n; begin += count) {
    count = std::min(n - begin, batch_size);
    const auto is_same_pixel = [&](std::size_t i) {
      return part_of(input.keys[i]).shift == part_of(input.keys[i - 1]).shift;
    };
    while (begin + count < n && is_same_pixel(begin + count)) ++count;
    for (std::size_t i = begin; i < begin + count; ++i) add_point(input, i, batch);
    const auto trace = [&](const auto& use) {
      if (input.unshadowed.empty())
        return batch.trace_lights(
            [&](std::size_t l, std::size_t p, int s, float e, float) { use(l, p, s, e); });
      batch.trace_lights([&](std::size_t l, std::size_t p, int s, float e, float free) {
        use(l, p, s, e);
        input.unshadowed[begin + p] += colours[l] * free;
      });
    };
    if (batch.samples() < 2) {
      trace([&](std::size_t l, std::size_t p, int, float e) { transfers[l].weights[begin + p] = e; });
      continue;
    }
    sums.assign(count * lights.size(), {});
    trace([&](std::size_t l, std::size_t p, int s, float e) {
      sums[l * count + p][halves.of(s)] += double(e);
    });
    for (std::size_t l = 0; l < lights.size(); ++l)
      for (std::size_t p = 0; p < count; ++p) {
        const std::array<double, 2>& sum = sums[l * count + p];
        transfers[l].weights[begin + p] = float(sum[0] + sum[1]);
        if (!input.variance.empty()) transfers[l].deviations[begin + p] = float(halves.deviation(sum));
      }
  }
  if (!input.variance.empty() && !is_delta(lights[0]))
    for (PointTransfers& t : transfers) fit_to_neighbours(t.weights, batch.samples() < 2, t.deviations);
  return transfers;
}

}  // namespace

void for_each_ray(const PointIrradianceInput& input, const UseOfRay& use, std::span<const Lobe> lobes) {
  constexpr int kMoreOfLobes = 4;
  const std::size_t n = input.points.size(), batch_size = batch_points(input.light_samples);
  for (std::size_t first = 0, count = 0; first < input.lights.size(); first += count) {
    count = sharing_rays(input.lights.subspan(first));
    const std::span<const Light> lights = input.lights.subspan(first, count);
    const int wanted =
        is_visible(lights[0]) || lobes.empty() ? input.light_samples : kMoreOfLobes * input.light_samples;
    ShadowBatch batch(input.rays, lights, input.boundary, shadow_rays(lights[0], wanted),
                      light_seed(input.seed, lights[0]));
    batch.keep_directions();
    for (std::size_t begin = 0; begin < n; begin += batch_size) {
      for (std::size_t i = begin; i < std::min(n, begin + batch_size); ++i)
        add_point(input, i, batch, lobes.empty() ? nullptr : &lobes[i]);
      batch.trace_lights([&](std::size_t l, std::size_t p, int s, float e, float) {
        if (e > 0) use(first + l, begin + p, batch.direction(p, s), e);
      });
    }
  }
}

std::vector<PointTransfers> transfers_at(const PointIrradianceInput& input) {
  std::vector<PointTransfers> transfers;
  add_transfers(input, transfers);
  return transfers;
}

void add_transfers(const PointIrradianceInput& input, std::vector<PointTransfers>& transfers) {
  transfers.resize(input.lights.size());
  for (std::size_t l = 0, count = 0; l < input.lights.size(); l += count) {
    count = sharing_rays(input.lights.subspan(l));
    const auto known = std::span(transfers).subspan(l, count);
    if (std::ranges::any_of(known, [](const PointTransfers& t) { return t.weights.empty(); }))
      std::ranges::move(transfers_to(input, input.lights.subspan(l, count)), known.begin());
  }
}

std::vector<RgbF> combine_lights(std::span<const PointTransfers> transfers,
                                 const PointIrradianceInput& input) {
  std::vector<RgbF> irradiance(input.points.size());
  for (std::size_t l = 0; l < input.lights.size(); ++l) {
    const RgbF colour(emission(input.lights[l]));
    const auto& [weights, deviations] = transfers[l];
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
      irradiance[i] += colour * weights[i];
      if (input.variance.empty() || deviations.empty()) continue;
      const Rgb deviation(colour * deviations[i]);
      input.variance[i] += deviation * deviation;
    }
  }
  return irradiance;
}

std::vector<RgbF> irradiance_at(const PointIrradianceInput& input) {
  return combine_lights(transfers_at(input), input);
}

std::vector<float> bend_all(const PointIrradianceInput& input, std::span<SurfacePoint> points) {
  std::vector<float> factors;
  if (!input.bend) return factors;
  for (SurfacePoint& point : points) factors.push_back(input.bend(point));
  return factors;
}

}  // namespace opaline
