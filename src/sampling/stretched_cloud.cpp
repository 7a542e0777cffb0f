// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/stretched_cloud.h"

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "core/parallel.h"
#include "core/random.h"
#include "sampling/sample_surface.h"

namespace opaline {
namespace {

std::vector<Standing> standing_on(const TriangleList& triangles,
                                  const std::vector<SampleGrid::Place>& places) {
  std::vector<Standing> all(places.size());
  parallel_chunks(places.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t t = places[i].triangle;
      all[i] = {triangles.corners(triangles.id(t)).at(places[i].u, places[i].v),
                triangles.geometric_normal(t)};
    }
  });
  return all;
}

struct Box {
  Vec3f low, high;
};

Box box_of(const TriangleList& triangles) {
  Box box{Vec3f(INFINITY), Vec3f(-INFINITY)};
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const TriangleList::Corners c = triangles.corners(triangles.id(t));
    box.low = component_min(box.low, Vec3f(component_min(c.a, component_min(c.b, c.c))));
    box.high = component_max(box.high, Vec3f(component_max(c.a, component_max(c.b, c.c))));
  }
  return box;
}

/// Samples by cells as wide as the search distance.
class GrowingCloud {
 public:
  GrowingCloud(const Vec3f& low, float distance) : low_(low), distance_(distance) {}

  bool is_clear(const Standing& s) const {
    const auto [x, y, z] = cell_of(s.position);
    for (std::int64_t i = x - 1; i <= x + 1; ++i)
      for (std::int64_t j = y - 1; j <= y + 1; ++j)
        for (std::int64_t k = z - 1; k <= z + 1; ++k)
          if (const auto cell = cells_.find(key(i, j, k)); cell != cells_.end())
            for (const Standing& other : cell->second) {
              const Vec3f d = other.position - s.position;
              if (dot(d, d) < distance_ * distance_ && same_sheet(s.normal, other.normal)) return false;
            }
    return true;
  }
  void add(const Standing& s) {
    const auto [x, y, z] = cell_of(s.position);
    cells_[key(x, y, z)].push_back(s);
  }

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3f& p) const {
    const Vec3f c = (p - low_) / distance_;
    return {std::int64_t(std::floor(c.x)), std::int64_t(std::floor(c.y)), std::int64_t(std::floor(c.z))};
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return morton_key(std::uint64_t(x + 1), std::uint64_t(y + 1), std::uint64_t(z + 1));
  }

  Vec3f low_;
  float distance_;
  std::unordered_map<std::uint64_t, std::vector<Standing>> cells_;
};

/// Positions in cells a little over twice as wide as a distance: everything within the distance is in one of
/// the eight cells around the nearest corner.
class CloseCells {
 public:
  CloseCells(std::span<const Standing> standing, float distance)
      : standing_(standing),
        distance2_(distance * distance),
        scale_(1 / (2.01f * distance)),
        entries_(std::bit_ceil(2 * standing.size() + 16)),
        seen_(entries_.size() / 8),
        older_(standing.size()) {
    for (const Standing& s : standing) low_ = component_min(low_, s.position);
  }

  /// True if any earlier position is close to the i-th and on its sheet; call in order.
  bool is_close(std::uint32_t i) {
    constexpr float kLast = 0x1p20f;  // cells beyond share one, which is only slower
    const Vec3f c = component_min((standing_[i].position - low_) * scale_, Vec3f(kLast)) + Vec3f(1);
    std::array<std::array<std::uint64_t, 2>, 3> near;  // coordinates of its cell and neighbour, shifted
    for (std::size_t k = 0; k < 3; ++k) {
      const auto own = std::uint64_t(c[k]);
      near[k] = {own << 21 * k, (c[k] - float(own) < 0.5f ? own - 1 : own + 1) << 21 * k};
    }
    for (unsigned corner = 1; corner < 8; ++corner) {
      const std::uint64_t key = near[0][corner & 1] | near[1][corner >> 1 & 1] | near[2][corner >> 2];
      if (is_seen(key) && any_in(entries_[slot_of(key)].newest, i)) return true;
    }
    const std::uint64_t key = near[0][0] | near[1][0] | near[2][0];
    Entry& entry = entries_[slot_of(key)];
    if (any_in(entry.newest, i)) return true;
    seen_[bit_of(key) >> 6] |= std::uint64_t(1) << (bit_of(key) & 63);
    older_[i] = entry.newest;
    entry = {key, i};
    return false;
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  struct Entry {
    std::uint64_t key = 0;
    std::uint32_t newest = kNone;  // newest place of the cell
  };

  std::size_t slot_of(std::uint64_t key) const {
    std::size_t slot = std::size_t((key * 0x9E3779B97F4A7C15ull) >> 20) & (entries_.size() - 1);
    while (entries_[slot].newest != kNone && entries_[slot].key != key)
      slot = (slot + 1) & (entries_.size() - 1);
    return slot;
  }
  // Most cells are empty; a bit filter for existing ones fits into the cache.
  std::size_t bit_of(std::uint64_t key) const {
    return std::size_t((key * 0xD6E8FEB86659FD93ull) >> 30) & (64 * seen_.size() - 1);
  }
  bool is_seen(std::uint64_t key) const { return seen_[bit_of(key) >> 6] >> (bit_of(key) & 63) & 1; }

  bool any_in(std::uint32_t newest, std::uint32_t i) const {
    for (std::uint32_t j = newest; j != kNone; j = older_[j]) {
      const Vec3f d = standing_[j].position - standing_[i].position;
      if (dot(d, d) < distance2_ && same_sheet(standing_[j].normal, standing_[i].normal)) return true;
    }
    return false;
  }

  std::span<const Standing> standing_;
  float distance2_, scale_;
  Vec3f low_{INFINITY};
  std::vector<Entry> entries_;       // a power of two of them
  std::vector<std::uint64_t> seen_;  // eight bits per entry
  std::vector<std::uint32_t> older_;
};

}  // namespace

StretchedCloud::StretchedCloud(const TriangleList& before, const TriangleList& after, float radius,
                               std::vector<SampleGrid::Place> places)
    : before_(before), after_(after), radius_(radius), places_(std::move(places)) {}

bool any_closer(std::span<const Standing> standing, float distance) {
  CloseCells cells(standing, distance);
  for (std::uint32_t i = 0; i < standing.size(); ++i)
    if (cells.is_close(i)) return true;
  return false;
}

std::size_t StretchedCloud::remove_crowded(float radii) {
  const std::vector<Standing> standing = standing_on(after_, places_);
  if (!any_closer(standing, radii * radius_)) return 0;
  // Random choice of the remaining samples, equal in every frame.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> lots(places_.size());
  for (std::uint32_t i = 0; i < lots.size(); ++i) {
    const SampleGrid::Place& p = places_[i];
    lots[i] = {
        hash_bits(std::uint64_t(std::bit_cast<std::uint32_t>(p.u)) << 32 | std::bit_cast<std::uint32_t>(p.v),
                  p.triangle),
        i};
  }
  std::ranges::sort(lots);
  GrowingCloud cloud(box_of(after_).low, radii * radius_);
  std::vector<std::uint32_t> kept;
  for (const auto& [lot, i] : lots) {
    if (!cloud.is_clear(standing[i])) continue;
    cloud.add(standing[i]);
    kept.push_back(i);
  }
  std::ranges::sort(kept);
  const std::size_t removed = places_.size() - kept.size();
  std::vector<SampleGrid::Place> places;
  for (const std::uint32_t i : kept) places.push_back(places_[i]);
  places_ = std::move(places);
  return removed;
}

std::size_t StretchedCloud::fill_gaps(float radii) {
  constexpr double kTriesPerArea = 4;  // in squared clearances
  const float clearance = radii * radius_;
  std::vector<std::size_t> grown;
  for (std::size_t t = 0; t < after_.size(); ++t)
    if (after_.area(t) > kGrown * before_.area(t)) grown.push_back(t);
  if (grown.empty()) return 0;
  GrowingCloud cloud(box_of(after_).low, clearance);
  for (const Standing& s : standing_on(after_, places_)) cloud.add(s);
  std::size_t added = 0;
  for (const std::size_t t : grown) {
    const TriangleList::Corners corners = after_.corners(after_.id(t));
    const Vec3f normal = after_.geometric_normal(t);
    const double tries = std::ceil(kTriesPerArea * after_.area(t) / double(clearance * clearance));
    for (std::uint64_t k = 0; double(k) < tries; ++k) {
      auto [u, v] = r2_point(k, {unit_double(hash_bits(1, 2 * t)), unit_double(hash_bits(1, 2 * t + 1))});
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Standing s{corners.at(float(u), float(v)), normal};
      if (!cloud.is_clear(s)) continue;
      cloud.add(s);
      places_.push_back({std::uint32_t(t), float(u), float(v)});
      ++added;
    }
  }
  return added;
}

SampleGrid StretchedCloud::grid() const {
  const std::vector<Standing> standing = standing_on(after_, places_);
  const auto [low, high] = box_of(after_);
  SampleGrid grid(low, high, 2 * radius_);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // by cell
  for (std::uint32_t i = 0; i < standing.size(); ++i) order.emplace_back(grid.key(standing[i].position), i);
  std::ranges::sort(order);
  for (std::size_t i = 0; i < order.size(); ++i)
    if (i == 0 || order[i].first != order[i - 1].first) grid.reserve_cell(order[i].first);
  for (std::size_t i = 0; i < order.size(); ++i) {
    SampleGrid::Cell& cell = grid.cell(order[i].first);
    if (cell.round_count++ == 0) cell.round_first = std::uint32_t(i);
  }
  grid.end_round([&](std::uint32_t i) {
    const std::uint32_t s = order[i].second;
    return SampleGrid::Sample{standing[s].position, places_[s]};
  });
  grid.finish();
  return grid;
}

}  // namespace opaline
