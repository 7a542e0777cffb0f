// SPDX-License-Identifier: GPL-3.0-or-later
// Poisson-disk samples on triangles, per sheet.
#pragma once

#include <tbb/parallel_sort.h>

#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "opaline/monitor.h"
#include "sampling/sample_grid.h"
#include "sampling/sample_surface.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// Candidate point of the surface, with no accepted sample within the radius yet.
struct Candidate {
  Vec3f position;
  SampleGrid::Place place;  // its triangle is an index into the TriangleList
  std::uint32_t order;      // random: order of the candidates within a cell
};

/// A candidate in its cell. Sorted by phase (the cell's parities), cell and random order.
struct CandidateEntry {
  std::uint64_t cell;  // its key, with the phase moved from the lowest bits to the highest
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

/// Dart throwing in phase groups (Wei 2008) over a hash grid: rounds of candidates, accepted if no sample of
/// their sheet is within the radius; independent of threads.
class PoissonDisk {
 public:
  PoissonDisk(const TriangleList& triangles, const Bounds& box, float radius)
      : triangles_(triangles), radius_(radius), grid_(Vec3f(box.low), Vec3f(box.high), 2 * radius) {}

  /// One round of about `count` candidates, stratified over the area; rejects those blocked by samples early.
  /// Large rounds are divided, to limit memory.
  void throw_darts(std::size_t count, std::uint64_t seed, Monitor* monitor) {
    const std::size_t throws = chunk_count(count, kMostCandidates), each = chunk_count(count, throws);
    for (std::size_t i = 0; i < throws; ++i) throw_some(each, i == 0 ? seed : hash_bits(seed, i), monitor);
  }

  /// The last round: centroids of triangles without samples nearby, so each part of the surface, however
  /// small, has a sample.
  void cover_centroids(Monitor* monitor) {
    run_round(triangles_.size(), 2 * radius_, monitor,
              [&](std::size_t begin, std::size_t end, const auto& keep) {
                for (std::size_t t = begin; t < end; ++t)
                  keep(t, 1.0f / 3, 1.0f / 3, std::uint32_t(hash_bits(0, t)));
              });
  }

  SampleGrid& grid() { return grid_; }

 private:
  static constexpr std::size_t kMostCandidates = std::size_t(1) << 21;

  void throw_some(std::size_t count, std::uint64_t seed, Monitor* monitor) {
    run_round(count, radius_, monitor, [&](std::size_t begin, std::size_t end, const auto& keep) {
      const double step = triangles_.area() / double(count);
      std::size_t t = triangles_.find(double(begin) * step);
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint64_t bits = hash_bits(seed, 2 * i), more = hash_bits(seed, 2 * i + 1);
        const double place = (double(i) + unit_double(more)) * step;
        while (t + 1 < triangles_.size() && triangles_.cumulative(t) <= place) ++t;
        float u = float(bits >> 40) * 0x1p-24f, v = float(bits & 0xFFFFFF) * 0x1p-24f;
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        keep(t, u, v, std::uint32_t(more));
      }
    });
  }

  template <class Generate>
  void run_round(std::size_t count, float clearance, Monitor* monitor, const Generate& generate) {
    Candidates candidates(count);
    parallel_chunks(count, Candidates::kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      generate(begin, end, [&](std::size_t t, float u, float v, std::uint32_t order) {
        const Vec3f p = triangles_.corners(triangles_.id(t)).at(u, v);
        if (is_clear(p, t, clearance))
          candidates.chunk(chunk).push_back({p, {std::uint32_t(t), u, v}, order});
      });
      candidates.chunk(chunk).shrink_to_fit();
      advance(monitor, end - begin);
    });
    insert(candidates, monitor);
  }

  // True if no accepted sample of the triangle's sheet is within the clearance.
  bool is_clear(const Vec3f& p, std::size_t triangle, float clearance) const {
    bool clear = true;
    const auto is_blocked_in = [&](const SampleGrid::Cell& cell) {
      for (std::uint32_t i = cell.first; i < cell.first + cell.count && clear; ++i) {
        const Vec3f away = grid_.position(i) - p;
        clear = dot(away, away) >= clearance * clearance || !on_one_sheet(triangle, grid_.place(i).triangle);
      }
      return !clear;
    };
    // Most candidates are blocked, mostly by samples in their own cell.
    if (const SampleGrid::Cell* own = grid_.find_cell(p); own != nullptr && is_blocked_in(*own)) return false;
    grid_.for_cells_near(p, clearance, is_blocked_in);
    return clear;
  }

  bool on_one_sheet(std::size_t a, std::size_t b) const {
    return same_sheet(triangles_.geometric_normal(a), triangles_.geometric_normal(b));
  }

  void insert(const Candidates& candidates, Monitor* monitor) {
    std::vector<CandidateEntry> entries = candidates.sorted_entries(grid_);
    std::vector<std::uint32_t> runs;  // where each cell's entries begin
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (i == 0 || entries[i].cell != entries[i - 1].cell) runs.push_back(std::uint32_t(i));
    reserve_cells(entries, runs, monitor);
    for (std::size_t begin = 0; begin < runs.size();) {
      std::size_t end = begin;
      while (end < runs.size() && entries[runs[end]].phase() == entries[runs[begin]].phase()) ++end;
      parallel_chunks(end - begin, 64, [&](std::size_t first, std::size_t last, std::size_t) {
        advance(monitor, 0);
        for (std::size_t r = begin + first; r < begin + last; ++r)
          try_cell(candidates, entries, runs[r], r + 1 < runs.size() ? runs[r + 1] : entries.size());
      });
      begin = end;
    }
    grid_.end_round([&](std::uint32_t i) {
      const Candidate& c = candidates[entries[i].candidate];
      return SampleGrid::Sample{c.position, c.place};
    });
  }

  // In Morton order, so neighbours in space are neighbours in memory.
  void reserve_cells(const std::vector<CandidateEntry>& entries, const std::vector<std::uint32_t>& runs,
                     Monitor* monitor) {
    std::vector<std::uint64_t> keys;
    keys.reserve(runs.size());
    for (const std::uint32_t run : runs) keys.push_back(entries[run].key());
    tbb::parallel_sort(keys);
    for (const std::uint64_t key : keys) {
      advance(monitor, 0);
      grid_.reserve_cell(key);
    }
  }

  // Tries one cell's candidates in order, and moves accepted ones to the front of its run. Cells of one phase
  // are two radii apart, hence independent.
  void try_cell(const Candidates& candidates, std::vector<CandidateEntry>& entries, std::size_t begin,
                std::size_t end) {
    SampleGrid::Cell& own = grid_.cell(entries[begin].key());
    own.round_first = std::uint32_t(begin);
    for (std::size_t i = begin; i < end; ++i) {
      const Candidate& mine = candidates[entries[i].candidate];
      const auto is_blocked_in = [&](const SampleGrid::Cell& cell) {
        bool free = true;
        for (std::uint32_t k = 0; k < cell.round_count && free; ++k) {
          const Candidate& other = candidates[entries[cell.round_first + k].candidate];
          const Vec3f away = other.position - mine.position;
          free = dot(away, away) >= radius_ * radius_ ||
                 !on_one_sheet(mine.place.triangle, other.place.triangle);
        }
        return !free;
      };
      bool free = !is_blocked_in(own);  // usually avoids searching the cells around
      if (free)
        grid_.for_cells_near(mine.position, radius_, [&](const SampleGrid::Cell& cell) {
          free = &cell == &own || !is_blocked_in(cell);
          return !free;
        });
      if (free) std::swap(entries[i], entries[begin + own.round_count++]);
    }
  }

  const TriangleList& triangles_;
  float radius_;
  SampleGrid grid_;
};

}  // namespace opaline
