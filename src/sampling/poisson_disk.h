// SPDX-License-Identifier: GPL-3.0-or-later
// Samples over triangles, no two of one sheet closer than a radius.
#pragma once

#include <tbb/parallel_sort.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "opaline/monitor.h"
#include "sampling/candidates.h"
#include "sampling/sample_grid.h"
#include "sampling/sample_surface.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// Dart throwing in phase groups (Wei 2008) over a hash grid: rounds of candidates, of which those are
/// accepted that no sample of their sheet is nearer to than the radius, the same ones whatever the threads.
class PoissonDisk {
 public:
  PoissonDisk(const TriangleList& triangles, const Bounds& box, float radius)
      : triangles_(triangles), radius_(radius), grid_(Vec3f(box.low), Vec3f(box.high), 2 * radius) {}

  /// One round: about `count` candidates, stratified over the area; those far from all samples are tried for
  /// real. A round of many is thrown in several, for memory's sake.
  void throw_darts(std::size_t count, std::uint64_t seed, Monitor* monitor) {
    const std::size_t throws = chunk_count(count, kMostCandidates), each = chunk_count(count, throws);
    for (std::size_t i = 0; i < throws; ++i) throw_some(each, i == 0 ? seed : hash_bits(seed, i), monitor);
  }

  /// The last round: the centroids of triangles with nothing near, so no part of the surface, however
  /// small, stays without a sample.
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

  // No accepted sample of the triangle's sheet lies within the clearance.
  bool is_clear(const Vec3f& p, std::size_t triangle, float clearance) const {
    bool clear = true;
    const auto is_blocked_in = [&](const SampleGrid::Cell& cell) {
      for (std::uint32_t i = cell.first; i < cell.first + cell.count && clear; ++i) {
        const Vec3f away = grid_.position(i) - p;
        clear = dot(away, away) >= clearance * clearance || !on_one_sheet(triangle, grid_.place(i).triangle);
      }
      return !clear;
    };
    // Most candidates are blocked, and most of those from within their own cell.
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

  // Tries one cell's candidates in order; the accepted ones move to the front of its run. Cells of one phase
  // are two radii apart, so none sees another at work.
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
      bool free = !is_blocked_in(own);  // saves most of them the look at the cells around
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
