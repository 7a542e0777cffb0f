// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/kernel_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "diffusion/interpolating_cubic.h"

namespace opaline {

KernelTable::KernelTable(const DiffuseProfile& profile, double r_min, double r_max)
    : KernelTable(profile, diffuse_reflectance_profile, r_min, r_max) {}

KernelTable KernelTable::of_far_side(const DiffuseProfile& profile, double r_min, double r_max) {
  return {profile, far_side_profile, r_min, r_max};
}

KernelTable::KernelTable(const DiffuseProfile& profile, Kernel kernel, double r_min, double r_max) {
  // One length scale, so s does not change when everything is scaled by a power of two.
  const double scale = r_max;
  inverse_scale2_ = float(1 / (scale * scale));
  const auto reflectance = [&](std::size_t channel, double s) {
    return kernel(profile.channels[channel], std::sqrt(s) * scale);
  };
  // Ends once the last channel is below 1e-30 of the transmitted flux per squared scale.
  const auto negligible = [&](double s) {
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, reflectance(c, s));
    return largest * scale * scale < 1e-30;
  };
  constexpr int kPerOctave = 1 << kSegmentBits;
  const int low_octave = std::max(-100, int(std::floor(2 * std::log2(r_min / r_max))));
  int high_octave = 1;  // s_max = 2: r_max itself lies inside
  while (high_octave > low_octave + 1 && negligible(std::exp2(high_octave - 1))) --high_octave;

  s_min_ = float(std::exp2(low_octave));
  s_max_ = float(std::exp2(high_octave));
  first_ = std::bit_cast<std::uint32_t>(s_min_) >> kFractionBits;
  const std::array<double, 4> nodes = chebyshev_points();

  for (int octave = low_octave; octave < high_octave; ++octave)
    for (int part = 0; part < kPerOctave; ++part) {
      const double start = std::exp2(octave) * (1 + double(part) / kPerOctave);
      const double width = std::exp2(octave) / kPerOctave;
      Segment segment{};
      for (int c = 0; c < 3; ++c) {
        std::array<double, 4> values{};
        for (int i = 0; i < 4; ++i) values[i] = reflectance(std::size_t(c), start + width * nodes[i]);
        if (*std::ranges::min_element(values) * scale * scale < 1e-30)
          continue;  // one channel may end before others
        const std::array<double, 4> cubic = interpolating_cubic(nodes, values);
        segment.c0[c] = float(cubic[0]);
        segment.c1[c] = float(cubic[1]);
        segment.c2[c] = float(cubic[2]);
        segment.c3[c] = float(cubic[3]);
      }
      segments_.push_back(segment);
    }
  segments_.push_back(Segment{});  // beyond s_max: exactly 0
}

}  // namespace opaline
