// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/orient.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/topology.h"
#include "opaline/geometry/mesh.h"

namespace opaline {
namespace {

/// Union-find over triangles that also knows whether two joined triangles must be wound alike.
class WindingSets {
 public:
  explicit WindingSets(std::size_t count) : parent_(count), opposite_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// The set's lowest triangle, and whether t must be wound opposite to it.
  std::pair<std::uint32_t, bool> find(std::uint32_t t) {
    std::uint32_t root = t;
    bool opposite = false;
    for (; parent_[root] != root; root = parent_[root]) opposite ^= opposite_[root] != 0;
    bool rest = opposite;
    for (std::uint32_t at = t; at != root;) {  // shorten the path
      const std::uint32_t next = parent_[at];
      const bool step = opposite_[at] != 0;
      parent_[at] = root;
      opposite_[at] = rest;
      rest ^= step;
      at = next;
    }
    return {root, opposite};
  }

  /// False if a and b are joined already the other way.
  bool join(std::uint32_t a, std::uint32_t b, bool opposite) {
    const auto [root_a, from_a] = find(a);
    const auto [root_b, from_b] = find(b);
    if (root_a == root_b) return (from_a ^ from_b) == opposite;
    const auto [low, high] = std::minmax(root_a, root_b);
    parent_[high] = low;
    opposite_[high] = from_a ^ from_b ^ opposite;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<unsigned char> opposite_;
};

struct Component {
  std::uint32_t first = 0, count = 0;  // in Orienter::order_
  std::uint32_t opposite = 0;          // how many are wound against the first one
  bool closed = true;
};

/// A closed component with a volume.
struct Solid {
  std::uint32_t component = 0;
  double volume = 0;
  Bounds box;
};

/// Of the tetrahedron below the triangle, times 6.
double signed_volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& origin) {
  return dot(a - origin, cross(b - origin, c - origin));
}

/// A flat double sheet has no outside. size: sum of the magnitudes that sum to the volume.
bool is_flat(double volume, double size) {
  return std::abs(volume) <= 1e-12 * size;
}

class Orienter {
 public:
  Orienter(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
           const EdgeTable& edges)
      : positions_(positions), triangles_(triangles), edges_(edges), sets_(triangles.size()) {}

  Winding run() {
    result_.flip.resize(triangles_.size());
    join_neighbours();
    collect_components();
    for (const Component& component : components_) agree(component);
    find_closed();
    number_closed();
    turn_outward();
    return std::move(result_);
  }

 private:
  void join_neighbours() {
    edges_.for_each([&](std::uint32_t, std::uint32_t, std::span<const std::uint32_t> corners) {
      if (corners.size() != 2) return;
      const bool same_direction = start(corners[0]) == start(corners[1]);
      if (!sets_.join(corners[0] / 3, corners[1] / 3, same_direction))
        unorientable_.push_back(corners[0] / 3);
    });
    result_.unorientable_edges = unorientable_.size();
  }

  std::uint32_t start(std::uint32_t corner) const { return triangles_[corner / 3][corner % 3]; }

  void collect_components() {
    component_of_.resize(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto [root, opposite] = sets_.find(t);
      component_of_[t] = root == t ? std::uint32_t(components_.size()) : component_of_[root];
      if (root == t) components_.emplace_back();
      ++components_[component_of_[t]].count;
      components_[component_of_[t]].opposite += opposite;
      result_.flip[t] = opposite;
    }
    for (const std::uint32_t t : unorientable_) components_[component_of_[t]].closed = false;
    sort_by_component();
  }

  void sort_by_component() {
    std::vector<std::uint32_t> next;
    for (std::uint32_t at = 0; Component & component : components_) {
      next.push_back(component.first = at);
      at += component.count;
    }
    order_.resize(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) order_[next[component_of_[t]]++] = t;
  }

  std::span<const std::uint32_t> members(const Component& component) const {
    return std::span(order_).subspan(component.first, component.count);
  }

  /// Where neighbours disagree, the smaller part gives way.
  void agree(const Component& component) {
    if (component.opposite > component.count - component.opposite) flip_all(component);
    result_.inconsistent += std::min(component.opposite, component.count - component.opposite);
  }

  void flip_all(const Component& component) {
    for (const std::uint32_t t : members(component)) result_.flip[t] = !result_.flip[t];
  }

  /// A component is closed if an even number of its triangles meets in each of its edges.
  void find_closed() {
    edges_.for_each([&](std::uint32_t, std::uint32_t, std::span<const std::uint32_t> corners) {
      for (const std::uint32_t corner : corners) {
        const std::uint32_t own = component_of_[corner / 3];
        const auto meets = std::count_if(corners.begin(), corners.end(), [&](std::uint32_t other) {
          return component_of_[other / 3] == own;
        });
        if (meets % 2 != 0) components_[own].closed = false;
      }
    });
  }

  void number_closed() {
    std::vector<std::uint32_t> number(components_.size(), Winding::kOpen);
    for (std::uint32_t i = 0; i < components_.size(); ++i)
      if (components_[i].closed) number[i] = result_.parts++;
    result_.part.resize(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) result_.part[t] = number[component_of_[t]];
  }

  /// The triangle with its corners in the order found so far.
  Triangle wound(std::uint32_t t) const {
    const Triangle& c = triangles_[t];
    return result_.flip[t] ? Triangle{c[0], c[2], c[1]} : c;
  }

  Solid measure(std::uint32_t index) const {
    Solid solid;
    solid.component = index;
    const std::span<const std::uint32_t> own = members(components_[index]);
    const Vec3d origin = positions_[triangles_[own[0]][0]];
    double size = 0;
    for (const std::uint32_t t : own) {
      const auto [a, b, c] = wound(t);
      const double part = signed_volume(positions_[a], positions_[b], positions_[c], origin);
      solid.volume += part;
      size += std::abs(part);
      for (const std::uint32_t v : {a, b, c}) {
        solid.box.low = component_min(solid.box.low, positions_[v]);
        solid.box.high = component_max(solid.box.high, positions_[v]);
      }
    }
    if (is_flat(solid.volume, size)) solid.volume = 0;
    return solid;
  }

  void turn_outward() {
    bool any_inward = false;
    for (std::uint32_t i = 0; i < components_.size(); ++i) {
      if (!components_[i].closed) continue;
      solids_.push_back(measure(i));
      any_inward |= solids_.back().volume < 0;
    }
    if (!any_inward) return;
    std::vector<std::uint32_t> inverted;
    for (const Solid& solid : solids_)
      if (solid.volume != 0 && outermost_around(solid).volume < 0) inverted.push_back(solid.component);
    for (const std::uint32_t i : inverted) {
      flip_all(components_[i]);
      result_.inside_out += components_[i].count;
    }
  }

  /// The largest solid around this one, or itself.
  const Solid& outermost_around(const Solid& inner) const {
    const Vec3d& point = positions_[triangles_[members(components_[inner.component])[0]][0]];
    const Solid* best = &inner;
    for (const Solid& outer : solids_) {
      const bool encloses = component_min(outer.box.low, inner.box.low) == outer.box.low &&
                            component_max(outer.box.high, inner.box.high) == outer.box.high;
      if (encloses && std::abs(outer.volume) > std::abs(best->volume) && contains(outer, point))
        best = &outer;
    }
    return *best;
  }

  /// By the winding number: the solid angle of the whole component seen from the point, after van Oosterom &
  /// Strackee 1983.
  bool contains(const Solid& solid, const Vec3d& point) const {
    double angle = 0;
    for (const std::uint32_t t : members(components_[solid.component])) {
      const auto [ia, ib, ic] = wound(t);
      const Vec3d a = positions_[ia] - point, b = positions_[ib] - point, c = positions_[ic] - point;
      const double la = length(a), lb = length(b), lc = length(c);
      angle += 2 * std::atan2(dot(a, cross(b, c)),
                              la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    constexpr double half_sphere = 6.283185307179586;
    return std::abs(angle) > half_sphere;
  }

  const std::vector<Vec3d>& positions_;
  const std::vector<Triangle>& triangles_;
  const EdgeTable& edges_;
  WindingSets sets_;
  std::vector<std::uint32_t> component_of_, order_, unorientable_;
  std::vector<Component> components_;
  std::vector<Solid> solids_;
  Winding result_;
};

}  // namespace

Winding find_winding(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                     const EdgeTable& edges) {
  return Orienter(positions, triangles, edges).run();
}

bool any_inward(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                const std::vector<std::uint32_t>& part, std::uint32_t parts) {
  struct Sum {
    const Vec3d* origin = nullptr;
    double volume = 0, size = 0;
  };
  std::vector<Sum> sums(parts);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (part[t] == Winding::kOpen) continue;
    Sum& sum = sums[part[t]];
    const auto& [a, b, c] = triangles[t];
    if (sum.origin == nullptr) sum.origin = &positions[a];
    const double volume = signed_volume(positions[a], positions[b], positions[c], *sum.origin);
    sum.volume += volume;
    sum.size += std::abs(volume);
  }
  return std::ranges::any_of(sums, [](const Sum& s) { return s.volume < 0 && !is_flat(s.volume, s.size); });
}

}  // namespace opaline
