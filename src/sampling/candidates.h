// SPDX-License-Identifier: GPL-3.0-or-later
// The places that a round of dart throwing tries.
#pragma once

#include <tbb/parallel_sort.h>

#include <compare>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "sampling/sample_grid.h"

namespace opaline {

/// A place on the surface that has no accepted sample within the radius yet.
struct Candidate {
  Vec3f position;
  SampleGrid::Place place;  // its triangle is an index into the TriangleList
  std::uint32_t order;      // random: the order in which a cell's candidates are tried
};

/// A candidate in its cell. Sorted by phase (the cell's parities), cell and random order.
struct CandidateEntry {
  std::uint64_t cell;  // its key, the phase moved from the lowest bits to the highest
  std::uint32_t order, candidate;
  std::uint64_t phase() const { return cell >> 61; }
  std::uint64_t key() const { return cell << 3 | phase(); }
  friend auto operator<=>(const CandidateEntry&, const CandidateEntry&) = default;
};

/// The candidates of a round, chunk by chunk as they were generated.
class Candidates {
 public:
  explicit Candidates(std::size_t tried) : chunks_(chunk_count(tried, kChunk)) {}
  std::vector<Candidate>& chunk(std::size_t c) { return chunks_[c]; }
  const Candidate& operator[](std::uint32_t i) const { return chunks_[i / kChunk][i % kChunk]; }

  std::vector<CandidateEntry> sorted_entries(const SampleGrid& grid) const {
    std::vector<std::size_t> firsts(1);
    for (const auto& chunk : chunks_) firsts.push_back(firsts.back() + chunk.size());
    std::vector<CandidateEntry> entries(firsts.back());
    parallel_chunks(chunks_.size(), 1, [&](std::size_t c, std::size_t, std::size_t) {
      for (std::size_t i = 0; i < chunks_[c].size(); ++i) {
        const std::uint64_t key = grid.key(chunks_[c][i].position);
        entries[firsts[c] + i] = {key >> 3 | key << 61, chunks_[c][i].order, std::uint32_t(c * kChunk + i)};
      }
    });
    tbb::parallel_sort(entries);
    return entries;
  }

  static constexpr std::size_t kChunk = 4096;

 private:
  std::vector<std::vector<Candidate>> chunks_;
};

}  // namespace opaline
