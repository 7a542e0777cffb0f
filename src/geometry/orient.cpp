// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/orient.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/topology.h"

namespace opaline {
namespace {

/// Union-find over triangles with the relative winding of two joined triangles.
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

  /// False if a and b are already joined with the other relative winding.
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
  bool closed = true, one_sided = false;
};

class Orienter {
 public:
  Orienter(const WoundMesh& mesh, const std::vector<Triangle>& sites, const EdgeTable& edges,
           bool decide_open)
      : mesh_(mesh), triangles_(sites), edges_(edges), decide_open_(decide_open), sets_(sites.size()) {}

  Winding run() {
    result_.flip.resize(triangles_.size());
    join_neighbours();
    collect_components();
    for (const Component& component : components_) agree(component);
    find_rims();
    name_parts();
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
    for (const std::uint32_t t : unorientable_) components_[component_of_[t]].one_sided = true;
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

  /// Where neighbours disagree, the smaller part is flipped.
  void agree(const Component& component) {
    if (component.opposite > component.count - component.opposite) flip_all(component);
    result_.inconsistent += std::min(component.opposite, component.count - component.opposite);
  }

  void flip_all(const Component& component) {
    for (const std::uint32_t t : members(component)) result_.flip[t] = !result_.flip[t];
  }

  /// A component is closed if an even number of its triangles meets at each of its edges. The other
  /// components have rims, at edges with more of their triangles in one direction than in the other.
  void find_rims() {
    edges_.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const std::uint32_t> corners) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t own = component_of_[corners[i] / 3];
        std::uint32_t meets = 0, before = 0;
        int upward = 0;  // triangles from low to high minus those from high to low
        for (std::size_t j = 0; j < corners.size(); ++j) {
          if (component_of_[corners[j] / 3] != own) continue;
          ++meets;
          before += j < i;
          upward += (start(corners[j]) == low) != result_.flip[corners[j] / 3] ? 1 : -1;
        }
        if (meets % 2 != 0) components_[own].closed = false;
        if (before > 0) continue;
        for (; upward > 0; --upward) rims_.push_back({own, low, high});
        for (; upward < 0; ++upward) rims_.push_back({own, high, low});
      }
    });
  }

  void name_parts() {
    MeshParts& parts = result_.parts;
    for (const Component& component : components_)
      parts.kinds.push_back(component.one_sided ? MeshParts::Kind::ignored
                            : component.closed  ? MeshParts::Kind::closed
                            : decide_open_      ? MeshParts::Kind::open
                                                : MeshParts::Kind::ignored);
    parts.of = component_of_;
    for (const MeshParts::RimEdge& edge : rims_)
      if (parts.kinds[edge.part] == MeshParts::Kind::open) parts.rims.push_back(edge);
  }

  void turn_outward() {
    std::vector<Triangle> wound = mesh_.triangles;
    for (std::size_t t = 0; t < wound.size(); ++t)
      if (result_.flip[t]) std::swap(wound[t][1], wound[t][2]);
    const std::vector<Inward> inward = inward_parts({mesh_.positions, wound, mesh_.normals}, result_.parts);
    for (std::size_t i = 0; i < inward.size(); ++i) {
      if (inward[i] == Inward::no) continue;
      flip_all(components_[i]);
      TurnedParts& turned = result_.turned[std::size_t(inward[i])];
      ++turned.parts;
      turned.triangles += components_[i].count;
    }
    for (MeshParts::RimEdge& edge : result_.parts.rims)
      if (inward[edge.part] != Inward::no) std::swap(edge.from, edge.to);
  }

  const WoundMesh& mesh_;
  const std::vector<Triangle>& triangles_;  // by sites
  const EdgeTable& edges_;
  bool decide_open_;
  WindingSets sets_;
  std::vector<std::uint32_t> component_of_, order_, unorientable_;
  std::vector<Component> components_;
  std::vector<MeshParts::RimEdge> rims_;
  Winding result_;
};

}  // namespace

Winding find_winding(const WoundMesh& mesh, const std::vector<Triangle>& sites, const EdgeTable& edges,
                     bool decide_open) {
  return Orienter(mesh, sites, edges, decide_open).run();
}

}  // namespace opaline
