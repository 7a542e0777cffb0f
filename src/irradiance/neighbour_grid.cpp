// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/neighbour_grid.h"

#include <bit>

namespace opaline {
namespace {

// Three coordinates of 21 bits; each is at least 1 and below 2^21 - 1, so a step to a neighbour stays in
// its bits.
constexpr int kBits = 21;
constexpr float kWidest = 0x1p20f;

std::uint64_t key_of(const Vec3f& place) {
  const auto coordinate = [](float c) { return std::uint64_t(c) + 1; };
  return coordinate(place.x) | coordinate(place.y) << kBits | coordinate(place.z) << 2 * kBits;
}

}  // namespace

NeighbourGrid::NeighbourGrid(std::span<const SurfaceSample> samples, float reach) {
  const auto bits = std::bit_width(2 * samples.size() + 1);
  slots_.assign(std::size_t(1) << bits, kNone);
  shift_ = 64 - int(bits);
  if (samples.empty()) return;
  Vec3f low = samples[0].position, high = low;
  for (const SurfaceSample& s : samples) widen(low, high, s.position);
  const float size = std::max(reach, max_component(high - low) / kWidest);
  std::vector<std::uint32_t> cell_of(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint64_t key = key_of((samples[i].position - low) / size);
    std::uint32_t& slot = slots_[slot_of(key)];
    if (slot == kNone) {
      slot = std::uint32_t(cells_.size());
      cells_.push_back({key});
    }
    cell_of[i] = slot;
    ++cells_[slot].count;
  }
  for (std::size_t c = 1; c < cells_.size(); ++c) cells_[c].first = cells_[c - 1].first + cells_[c - 1].count;
  members_.resize(samples.size());
  std::vector<std::uint32_t> filled(cells_.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    members_[cells_[cell_of[i]].first + filled[cell_of[i]]++] = {samples[i].position, i};
}

std::span<const std::uint32_t> NeighbourGrid::around(const Cell& cell,
                                                     std::array<std::uint32_t, 27>& indices) const {
  std::size_t found = 0;
  for (std::uint64_t z = 0; z < 3; ++z)
    for (std::uint64_t y = 0; y < 3; ++y)
      for (std::uint64_t x = 0; x < 3; ++x) {
        constexpr std::uint64_t kBack = 1 | std::uint64_t(1) << kBits | std::uint64_t(1) << 2 * kBits;
        const std::uint64_t step = x | y << kBits | z << 2 * kBits;
        const std::uint32_t index = slots_[slot_of(cell.key - kBack + step)];
        if (index != kNone) indices[found++] = index;
      }
  return {indices.data(), found};
}

// Slot of the cell's index, or the free slot for it.
std::size_t NeighbourGrid::slot_of(std::uint64_t key) const {
  std::size_t slot = (key * 0x9E3779B97F4A7C15ull) >> shift_;  // the top bits depend on all of the key
  while (slots_[slot] != kNone && cells_[slots_[slot]].key != key) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

}  // namespace opaline
