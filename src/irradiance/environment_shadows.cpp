// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/environment_shadows.h"

#include <algorithm>
#include <numeric>

namespace opaline {
namespace {

constexpr std::size_t kReach = 2;  // distance of blocks with rays used for a block
// Weights of the surrounding blocks and of all blocks, in rays; uncritical.
constexpr float kOfAround = 1, kOfAll = .5f;

}  // namespace

EnvironmentShadows::EnvironmentShadows(const EnvironmentPicture& environment) : environment_(environment) {
  for (Half& half : halves_) {
    half.tried.resize(environment.block_count());
    half.lit.resize(environment.block_count());
  }
}

// Sums over a square of blocks, periodic in the azimuth.
void EnvironmentShadows::spread(std::vector<float>& counts) {
  const std::size_t columns = environment_.block_columns(), rows = counts.size() / columns;
  spread_.assign(counts.size(), 0);
  for (std::size_t r = 0; r < rows; ++r) {
    const float* const row = &counts[r * columns];
    float sum = 0;
    for (std::size_t k = 0; k <= 2 * kReach; ++k) sum += row[k % columns];
    for (std::size_t c = 0; c < columns; ++c) {
      spread_[r * columns + (c + kReach) % columns] = sum;
      sum += row[(c + 2 * kReach + 1) % columns] - row[c];
    }
  }
  std::ranges::fill(counts, 0.0f);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t k = r - std::min(r, kReach); k <= std::min(r + kReach, rows - 1); ++k)
      for (std::size_t c = 0; c < columns; ++c) counts[r * columns + c] += spread_[k * columns + c];
}

void EnvironmentShadows::estimate(const std::array<bool, 2>& has_dark) {
  for (std::size_t h = 0; h < 2; ++h) {
    Half& half = halves_[h];
    half.open.assign(half.tried.size(), 1);
    if (!has_dark[h]) continue;
    const float tried = std::reduce(half.tried.begin(), half.tried.end()),
                lit = std::reduce(half.lit.begin(), half.lit.end());
    std::vector<float> tried_around = half.tried, lit_around = half.lit;
    spread(tried_around);
    spread(lit_around);
    for (std::size_t b = 0; b < half.open.size(); ++b) {
      const float around = (lit_around[b] + kOfAll * lit / tried) / (tried_around[b] + kOfAll);
      half.open[b] = (half.lit[b] + kOfAround * around) / (half.tried[b] + kOfAround);
    }
  }
}

RgbF EnvironmentShadows::irradiance(std::size_t half, const Vec3d& normal) {
  const std::size_t nearest = EnvironmentPicture::nearest_normal(normal);
  auto& known = halves_[1 - half].known;
  auto entry = std::ranges::find(known, nearest, [](const auto& k) { return k.first; });
  if (entry == known.end())
    entry = known.insert(entry, {nearest, environment_.unshadowed(nearest, halves_[1 - half].open)});
  return entry->second.at(normal);
}

}  // namespace opaline
