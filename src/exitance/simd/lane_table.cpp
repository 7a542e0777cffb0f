// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/simd/lane_table.h"

#include <algorithm>
#include <cmath>

#include "diffusion/interpolating_cubic.h"

namespace opaline {
namespace {

// Quadratic in t through the second differences of f at the Chebyshev points start + width t.
template <class Function>
std::array<double, 3> curvature_of(const Function& f, double start, double width) {
  std::array<double, 3> t{}, y{};
  for (std::size_t i = 0; i < 3; ++i) {
    t[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * (2 * double(i) + 1) / 6);
    const double q = start + width * t[i], step = 0.02 * width;
    y[i] = (f(q - step) - 2 * f(q) + f(q + step)) / (step * step);
  }
  const double d01 = (y[1] - y[0]) / (t[1] - t[0]), d12 = (y[2] - y[1]) / (t[2] - t[1]),
               d = (d12 - d01) / (t[2] - t[0]);
  return {y[0] - d01 * t[0] + d * t[0] * t[1], d01 - d * (t[0] + t[1]), d};
}

}  // namespace

LaneTable make_lane_table(const DiffuseProfile& profile, double h, double r_max, bool split) {
  LaneTable table;
  const double scale = h / 4;
  table.inverse_scale2 = float(1 / (scale * scale));
  const std::array<double, 4> nodes = chebyshev_points();
  for (std::size_t c = 0; c < 3; ++c) {
    const ChannelProfile& channel = profile.channels[c];
    table.decay[c] = float(slowest_decay(channel));
    const auto far_kernel = [&](double q) {
      const double r = std::sqrt(std::max(0.0, q - 1)) * scale;
      if (!split) return diffuse_reflectance_profile(channel, std::max(r, h / 10));
      return r > 0 ? diffuse_reflectance_profile(channel, r) * far_weight(r / h) : 0;
    };
    for (int segment = 0; segment + 1 < LaneTable::kSegments; ++segment) {
      const double octave = std::exp2(segment / 2), width = octave / 2,
                   start = octave + (segment % 2) * width;
      std::array<double, 4> values{};
      for (std::size_t i = 0; i < 4; ++i) values[i] = far_kernel(start + width * nodes[i]);
      const bool underflows = start > 32 && *std::ranges::min_element(values) * r_max * r_max < 1e-30;
      const std::array<double, 4> cubic = interpolating_cubic(nodes, values);
      if (underflows) continue;
      for (std::size_t power = 0; power < 4; ++power)
        table.coefficients[c][power][std::size_t(segment)] = float(cubic[power]);
      const float first = float(far_kernel(start));
      table.chord[c][0][std::size_t(segment)] = first;
      table.chord[c][1][std::size_t(segment)] = float(far_kernel(start + width)) - first;
      const std::array<double, 3> quadratic = curvature_of(far_kernel, start, width);
      for (std::size_t power = 0; power < 3; ++power)
        table.curvature[c][power][std::size_t(segment)] = float(quadratic[power]);
    }
  }
  return table;
}

}  // namespace opaline
