// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/border_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace opaline {
namespace {

constexpr int kRings = 192;

// Radii over h of the rings' edges, dense near the point, where steep profiles have most of their mass.
double ring_radius(int i) {
  return std::pow(double(i) / kRings, 4);
}

// Weight of each ring around the point over the sum of all, from the cumulative integral up to each ring's
// border.
std::vector<double> ring_shares(const std::vector<double>& within) {
  std::vector<double> shares;
  for (int i = 0; i < kRings; ++i) {
    const double ring = within[std::size_t(i) + 1] - within[std::size_t(i)];
    shares.push_back(within.back() > 0 ? ring / within.back() : 0);
  }
  return shares;
}

// Part of the rings on this side of a straight border at distance t h.
double inside_border(const std::vector<double>& shares, double t) {
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double radius = 0.5 * (ring_radius(i) + ring_radius(i + 1));
    const double outside = radius > t ? std::acos(t / radius) / std::numbers::pi : 0;
    sum += shares[std::size_t(i)] * (1 - outside);
  }
  return sum;
}

// Fractions of the weight (1 - t^2)^2, used for the sum of the samples' areas.
std::vector<double> area_shares() {
  std::vector<double> within;
  for (int i = 0; i <= kRings; ++i) within.push_back(1 - std::pow(1 - ring_radius(i) * ring_radius(i), 3));
  return ring_shares(within);
}

// Near fractions of 2 pi r R_d (1 - w(r/h)), integrated by parts: bounded even for steep profiles.
std::vector<double> near_shares(const ChannelProfile& profile, double h) {
  std::vector<double> within{0};
  double by_parts = 0;
  for (int i = 0; i < kRings; ++i) {
    const double a = ring_radius(i), b = ring_radius(i + 1), m = 0.5 * (a + b);
    by_parts += (b - a) * diffuse_reflectance_within(profile, m * h) * 30 * m * m * (1 - m) * (1 - m);
    within.push_back(diffuse_reflectance_within(profile, b * h) * (1 - far_weight(b)) + by_parts);
  }
  return ring_shares(within);
}

// For each row, the distance over h of the border leaving its fraction of the areas.
std::array<double, SplitKernel::kBorderRows> border_distances() {
  const std::vector<double> area = area_shares();
  std::array<double, SplitKernel::kBorderRows> distances{};
  for (std::size_t row = 0; row < SplitKernel::kBorderRows; ++row) {
    const double wanted = 0.5 + 0.5 * double(row) / (SplitKernel::kBorderRows - 1);
    double low = 0, high = 1;  // the area increases with the border's distance
    for (int i = 0; i < 20; ++i)
      (inside_border(area, 0.5 * (low + high)) < wanted ? low : high) = 0.5 * (low + high);
    distances[row] = 0.5 * (low + high);
  }
  return distances;
}

}  // namespace

std::array<std::array<float, 3>, SplitKernel::kBorderRows> border_shares(const DiffuseProfile& profile,
                                                                         double h) {
  static const std::array<double, SplitKernel::kBorderRows> distances = border_distances();  // takes 5 ms
  std::array<std::vector<double>, 3> near;
  for (std::size_t c = 0; c < 3; ++c) near[c] = near_shares(profile.channels[c], h);
  std::array<std::array<float, 3>, SplitKernel::kBorderRows> rows{};
  for (std::size_t row = 0; row < SplitKernel::kBorderRows; ++row)
    for (std::size_t c = 0; c < 3; ++c) rows[row][c] = float(inside_border(near[c], distances[row]));
  return rows;
}

}  // namespace opaline
