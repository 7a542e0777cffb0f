// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/irradiance/irradiance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "irradiance/shadow_batch.h"
#include "irradiance/shadow_edges.h"
#include "opaline/core/parallel.h"
#include "opaline/lights/light.h"

namespace opaline {
namespace {

// The first and the second half of the low-discrepancy points, each such a set itself, estimate the error of
// their mean: its standard error is the difference of the halves' means times sqrt(n0 n1) / n.
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

// Half of the rays are a worse set than all: how much worse depends on their number and the light, and a
// single ray has no halves. What a point is off the nearer of two neighbours by, when points that follow each
// other lie together, is noise, or a little more: the halves' errors are scaled to it on the whole, and never
// raised.
void fit_to_neighbours(const std::vector<float>& weights, bool single, std::vector<float>& deviations) {
  const std::size_t n = weights.size();
  if (n < 3) return;
  // Means of a normal distribution: the lesser of the two differences, and the absolute value.
  constexpr double kLesser = 0.71, kAbsolute = 0.80;
  double neighbours = 0, halves = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const float before = weights[i > 0 ? i - 1 : i + 2], after = weights[i + 1 < n ? i + 1 : i - 2];
    const float lesser = std::min(std::abs(weights[i] - before), std::abs(weights[i] - after));
    if (single) deviations[i] = lesser;  // as often as not all light or none
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

// unblocked: what the weights would be were nothing in the way.
LightTransfer transfer_from(const IrradianceInput& input, const Light& light, std::uint64_t seed,
                            std::vector<float>& unblocked) {
  LightTransfer transfer;
  transfer.weights.resize(input.samples.size());
  unblocked.resize(input.samples.size());
  // A single ray a point: enough of them that many lie together.
  constexpr std::size_t kSinglePoints = 4096;
  const std::size_t batch_size = is_delta(light) ? kSinglePoints : batch_points(input.light_samples);
  std::vector<ErrorSums> errors(chunk_count(input.samples.size(), batch_size));
  parallel_chunks(input.samples.size(), batch_size,
                  [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                    ShadowBatch batch(input.rays, light, input.eta, input.light_samples, seed);
                    batch.scatter();
                    batch.reserve(end - begin);
                    for (std::size_t i = begin; i < end; ++i) {
                      const SurfaceSample& s = input.samples[i];
                      batch.add(input.rays.surface_point(s.mesh, s.triangle, s.u, s.v), i);
                    }
                    const Halves halves(batch.samples());
                    std::vector<std::array<double, 2>> sums(end - begin);
                    batch.trace([&](std::size_t p, int s, float e, float free) {
                      sums[p][halves.of(s)] += double(e);
                      unblocked[begin + p] += free;
                    });
                    for (std::size_t p = 0; p < sums.size(); ++p) {
                      const double sum = sums[p][0] + sums[p][1];
                      transfer.weights[begin + p] = float(sum);
                      const double deviation = halves.deviation(sums[p]);
                      errors[chunk].variance += deviation * deviation;
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
  std::vector<std::vector<float>> unblocked(input.lights.size());
  for (std::size_t l = 0; l < input.lights.size(); ++l)
    transfers.push_back(
        transfer_from(input, input.lights[l], light_seed(input.seed, input.lights[l]), unblocked[l]));
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

PointTransfers transfers_at(const PointIrradianceInput& input, std::size_t light) {
  const std::size_t n = input.points.size(), batch_size = batch_points(input.light_samples);
  PointTransfers transfers;
  transfers.weights.resize(n);
  if (!input.variance.empty()) transfers.deviations.resize(n);
  ShadowBatch batch(input.rays, input.lights[light], input.eta, input.light_samples,
                    light_seed(input.seed, input.lights[light]));
  const Halves halves(batch.samples());
  std::vector<std::array<double, 2>> sums;  // over the halves of a point's rays
  batch.reserve(std::min(batch_size, n));
  for (std::size_t begin = 0; begin < n; begin += batch_size) {
    const std::size_t end = std::min(n, begin + batch_size);
    for (std::size_t i = begin; i < end; ++i) batch.add(input.points[i], input.keys[i]);
    if (batch.samples() < 2) {
      batch.trace([&](std::size_t p, int, float e, float) { transfers.weights[begin + p] = e; });
      continue;
    }
    sums.assign(end - begin, {});
    batch.trace([&](std::size_t p, int s, float e, float) { sums[p][halves.of(s)] += double(e); });
    for (std::size_t p = 0; p < sums.size(); ++p) {
      transfers.weights[begin + p] = float(sums[p][0] + sums[p][1]);
      if (!transfers.deviations.empty()) transfers.deviations[begin + p] = float(halves.deviation(sums[p]));
    }
  }
  if (!transfers.deviations.empty() && !is_delta(input.lights[light]))
    fit_to_neighbours(transfers.weights, batch.samples() < 2, transfers.deviations);
  return transfers;
}

void for_each_ray(const PointIrradianceInput& input, std::size_t light, const UseOfRay& use) {
  const std::size_t n = input.points.size(), batch_size = batch_points(input.light_samples);
  ShadowBatch batch(input.rays, input.lights[light], input.eta, input.light_samples,
                    light_seed(input.seed, input.lights[light]));
  batch.keep_directions();
  for (std::size_t begin = 0; begin < n; begin += batch_size) {
    for (std::size_t i = begin; i < std::min(n, begin + batch_size); ++i)
      batch.add(input.points[i], input.keys[i]);
    batch.trace([&](std::size_t p, int s, float e, float) {
      if (e > 0) use(begin + p, batch.direction(p, s), e);
    });
  }
}

std::vector<PointTransfers> transfers_at(const PointIrradianceInput& input) {
  std::vector<PointTransfers> transfers;
  for (std::size_t l = 0; l < input.lights.size(); ++l) transfers.push_back(transfers_at(input, l));
  return transfers;
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

}  // namespace opaline
