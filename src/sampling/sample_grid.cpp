// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/sample_grid.h"

namespace opaline {

void SampleGrid::reserve_cell(std::uint64_t key) {
  auto* block = const_cast<Block*>(find_block(key >> 6));
  if (block == nullptr) {
    blocks_.push_back({key >> 6, 0, {}});
    if (blocks_.size() * 2 > slots_.size()) grow();
    insert_slot(std::uint32_t(blocks_.size() - 1));
    block = &blocks_.back();
  }
  if (block->occupied >> (key & 63) & 1) return;
  block->occupied |= std::uint64_t(1) << (key & 63);
  block->cells[key & 63] = std::uint32_t(cells_.size());
  cells_.emplace_back();
}

void SampleGrid::finish() {
  curve_.clear();
  curve_.reserve(blocks_.size());
  for (const Block& block : blocks_) curve_.push_back({block.key, std::uint32_t(curve_.size())});
  std::ranges::sort(curve_, {}, &BlockOnCurve::key);
}

void SampleGrid::grow() {
  slots_.assign(slots_.size() * 2, kNone);
  --shift_;
  for (std::uint32_t i = 0; i + 1 < blocks_.size(); ++i) insert_slot(i);
}

void SampleGrid::insert_slot(std::uint32_t block) {
  std::size_t slot = hash(blocks_[block].key);
  while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
  slots_[slot] = block;
}

}  // namespace opaline
