// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/sample_grid.h"

namespace opaline {

void SampleGrid::reserve_cell(std::uint64_t key) {
  const auto place = [&](std::uint64_t k) {
    std::size_t slot = hash(k);
    while (keys_[slot] != kEmpty && keys_[slot] != k) slot = (slot + 1) & (keys_.size() - 1);
    return slot;
  };
  const std::size_t slot = place(key);
  if (keys_[slot] == key) return;
  keys_[slot] = key;
  if (++used_ * 2 < keys_.size()) return;
  std::vector<std::uint64_t> old_keys(keys_.size() * 2, kEmpty);
  std::vector<Cell> old_cells(cells_.size() * 2);
  --shift_;
  old_keys.swap(keys_);
  old_cells.swap(cells_);
  for (std::size_t i = 0; i < old_keys.size(); ++i) {
    if (old_keys[i] == kEmpty) continue;
    const std::size_t moved = place(old_keys[i]);
    keys_[moved] = old_keys[i];
    cells_[moved] = old_cells[i];
  }
}

void SampleGrid::add(std::uint64_t key, const Vec3f& position, const Vec3f& geometric_normal) {
  Cell& cell = *find(key);
  samples_.push_back({position, geometric_normal, cell.first});
  cell.first = std::uint32_t(samples_.size() - 1);
}

}  // namespace opaline
