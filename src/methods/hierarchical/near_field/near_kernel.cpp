// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/near_field/near_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.h"
#include "methods/hierarchical/hierarchical_state.h"

namespace opaline {
namespace {

constexpr double kBeyondReach = 0.02;  // fraction of a kernel beyond its reach

}  // namespace

NearKernel::NearKernel(const Body& group) : radius(hierarchical_state(group).kernel().radius) {
  const double h = double(radius);
  const auto& own_irradiance = hierarchical_state(group).kernel().own_irradiance;
  std::array<double, kRings> mean_rings{};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(own_irradiance[c] > 0)) continue;
    std::array<double, kRings> rings;
    for (std::size_t i = 0; i < kRings; ++i)
      rings[i] = near_ring(group.profile.channels[c], h, (double(i) + 0.5) / kRings);
    const double sum = std::accumulate(rings.begin(), rings.end(), 0.0);
    double inside = 0;
    for (std::size_t i = 0; i < kRings && sum > 0; ++i) {
      const float end = radius * float(i + 1) / kRings;
      if (inside < (1 - kBeyondReach) * sum) reach = std::max(reach, end);
      if (inside < sum / 2) half[c] = end;
      inside += rings[i];
      const double area = std::numbers::pi * h * h * double(2 * i + 1) / (kRings * kRings);
      densities[i][c] = float(rings[i] / (sum * area));
      mean_rings[i] += rings[i] / sum;
    }
    if (half[c] > 0) narrowest = narrowest > 0 ? std::min(narrowest, half[c]) : half[c];
  }
  const double all = std::accumulate(mean_rings.begin(), mean_rings.end(), 0.0);
  const float channels = float(std::round(all));
  double square = 0;
  for (std::size_t i = 0; i < kRings && all > 0; ++i) {
    densities[i][3] = (densities[i][0] + densities[i][1] + densities[i][2]) / channels;
    const double part = mean_rings[i] / all, r = h * (double(i) + 0.5) / kRings;
    within[i + 1] = within[i] + part;
    square += part * r * r;
  }
  root_mean_square = std::sqrt(square);
  for (const Densities& ring : densities)
    for (std::size_t c = 0; c < 3; ++c) key = hash_bits(key, std::bit_cast<std::uint32_t>(float(ring[c])));
}

double NearKernel::drawn_distance(double u) const {
  const auto above = std::ranges::upper_bound(within, u * within.back());
  const std::size_t ring = std::min(std::size_t(above - within.begin()), kRings) - 1;
  const double inside = within[ring], part = within[ring + 1] - inside;
  const double t = part > 0 ? std::min(1.0, (u * within.back() - inside) / part) : 0.5;
  return double(radius) * (double(ring) + t) / kRings;
}

}  // namespace opaline
