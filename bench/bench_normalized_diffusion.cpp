// SPDX-License-Identifier: GPL-3.0-or-later
// Refits normalized diffusion to random walks: of a half space in diffuse light the shape length d that has the
// least L1 difference of shape, by absorption and by boundary.
//
//   bench_normalized_diffusion [COLLISIONS]
//
// COLLISIONS a medium, 2e7 unless given: three minutes of CPU in all. Prints the table of
// src/diffusion/normalized_diffusion.cpp, mean free paths over d, and the differences that are left.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

#include "diffusion/normalized_diffusion.h"
#include "transport/half_space.h"
#include "transport/laboratory.h"

namespace {

using namespace opaline;

/// Of darker media the shape changes little, and few walks come back.
constexpr double kMostAbsorbed = .97;
/// Light that walks for longer leaves beyond the last ring.
constexpr std::uint64_t kMostCollisions = 1 << 18;

SlabWalks walk(double absorbed, double eta, double collisions) {
  LaboratorySettings settings;
  settings.most_collisions = kMostCollisions;
  settings.walks = 2048;
  const HomogeneousMedium medium{absorbed, 1 - absorbed, 0, eta};
  const double each = walk_slab(medium, {}, kDiffuseEntry, settings).collisions + 3;
  settings.walks = std::size_t(std::clamp(collisions / each, 2048., 1e6));
  return walk_slab(medium, {}, kDiffuseEntry, settings);
}

/// Of the shape with mean free path over d = s; the rings' shares of all light that leaves.
double l1_difference(const SlabWalks& walked, double total, double s) {
  const NormalizedDiffusion model{1, 1 / s};
  double sum = 0, before = 0, left = 1;
  for (const WalkedRing& ring : walked.back.rings) {
    const double within = diffuse_reflectance_within(model, ring.high), share = ring.share.value / total;
    sum += std::abs(within - before - share);
    before = within;
    left -= share;
  }
  return sum + std::abs(1 - before - left);
}

}  // namespace

int main(int argc, char** argv) {
  const double collisions = argc > 1 ? std::strtod(argv[1], nullptr) : 2e7;
  std::string table, differences;
  for (const double eta : kRefitEtas) {
    std::string row, left;
    for (std::size_t i = 0; i < kRefitAbsorptions; ++i) {
      const double root = double(i) / double(kRefitAbsorptions - 1);
      const double absorbed = std::min(std::pow(root, 4), kMostAbsorbed);
      const SlabWalks walked = walk(absorbed, eta, collisions);
      const double total = half_space_albedo(absorbed, eta);
      const auto [logarithm, l1] = boost::math::tools::brent_find_minima(
          [&](double x) { return l1_difference(walked, total, std::exp(x)); }, -4., 4., 30);
      row += fmt::format("{}{:.3f}", i == 0 ? "" : ", ", std::exp(logarithm));
      left += fmt::format("{:7.3f}", l1);
    }
    table += fmt::format("    {{{}}},  // eta {}\n", row, eta);
    differences += fmt::format("{:7}{}\n", eta, left);
  }
  fmt::print("mean free path over d, columns absorbed = 0, .1^4, ... 1\n{}\nL1 differences left\n{}", table,
             differences);
}
