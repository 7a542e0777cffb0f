// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/stretched_cloud.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"
#include "opaline/sampling/sample_surface.h"

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

Vec3f lowest(const TriangleList& triangles) {
  Vec3f low(INFINITY);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const TriangleList::Corners c = triangles.corners(triangles.id(t));
    low = component_min(low, Vec3f(component_min(c.a, component_min(c.b, c.c))));
  }
  return low;
}

/// Samples one after the other, found by cells as wide as the distance asked for.
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

}  // namespace

StretchedCloud::StretchedCloud(const TriangleList& before, const TriangleList& after, float radius,
                               std::vector<SampleGrid::Place> places)
    : before_(before), after_(after), radius_(radius), places_(std::move(places)) {}

bool any_closer(std::span<const Standing> standing, float distance) {
  // Cells twice as wide as the distance: whoever is closer to a place is in one of the eight around the
  // cells' corner that is nearest to it.
  Vec3f low(INFINITY);
  for (const Standing& s : standing) low = component_min(low, s.position);
  const float scale = 1 / (2.01f * distance);
  constexpr float kLast = 0x1p20f;  // cells beyond are one: only slower
  const auto cell_of = [&](const Vec3f& p) {
    const Vec3f c = component_min((p - low) * scale, Vec3f(kLast)) + Vec3f(1);
    return std::array{c.x, c.y, c.z};
  };
  const auto key_of = [](const std::array<std::uint64_t, 3>& c) { return c[0] | c[1] << 21 | c[2] << 42; };
  const std::size_t slots = std::bit_ceil(2 * standing.size() + 1);
  const auto slot_of = [&](std::uint64_t key) {
    return std::size_t((key * 0x9E3779B97F4A7C15ull) >> 20) & (slots - 1);
  };
  constexpr std::uint32_t kNone = ~0u;
  struct Entry {
    std::uint64_t key;
    std::uint32_t newest;  // of the cell's members
  };
  std::vector<Entry> table(slots, {0, kNone});
  std::vector<std::uint32_t> older(standing.size());
  for (std::uint32_t i = 0; i < standing.size(); ++i) {
    const Standing& s = standing[i];
    const std::array<float, 3> at = cell_of(s.position);
    std::array<std::array<std::uint64_t, 2>, 3> near;  // its cell and the nearest neighbour, along each axis
    for (std::size_t k = 0; k < 3; ++k) {
      const auto own = std::uint64_t(at[k]);
      near[k] = {own, at[k] - float(own) < 0.5f ? own - 1 : own + 1};
    }
    for (unsigned corner = 8; corner-- > 0;) {
      const std::uint64_t key =
          key_of({near[0][corner & 1], near[1][corner >> 1 & 1], near[2][corner >> 2 & 1]});
      std::size_t slot = slot_of(key);
      while (table[slot].newest != kNone && table[slot].key != key) slot = (slot + 1) & (slots - 1);
      for (std::uint32_t j = table[slot].newest; j != kNone; j = older[j]) {
        const Vec3f d = standing[j].position - s.position;
        if (dot(d, d) < distance * distance && same_sheet(standing[j].normal, s.normal)) return true;
      }
      if (corner > 0) continue;
      older[i] = table[slot].newest;  // its own cell is the last one
      table[slot] = {key, i};
    }
  }
  return false;
}

std::size_t StretchedCloud::remove_crowded(float radii) {
  const std::vector<Standing> standing = standing_on(after_, places_);
  if (!any_closer(standing, radii * radius_)) return 0;
  // Who stays is drawn by lot, the same one in every frame.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> lots(places_.size());
  for (std::uint32_t i = 0; i < lots.size(); ++i) {
    const SampleGrid::Place& p = places_[i];
    lots[i] = {
        hash_bits(std::uint64_t(std::bit_cast<std::uint32_t>(p.u)) << 32 | std::bit_cast<std::uint32_t>(p.v),
                  p.triangle),
        i};
  }
  std::ranges::sort(lots);
  GrowingCloud cloud(lowest(after_), radii * radius_);
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
  GrowingCloud cloud(lowest(after_), clearance);
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
  SampleGrid grid(lowest(after_), 2 * radius_);
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
  return grid;
}

}  // namespace opaline
