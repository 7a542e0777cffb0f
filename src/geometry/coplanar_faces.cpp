// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/coplanar_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace opaline {
namespace {

using Corners = std::array<Vec3d, 3>;

constexpr std::size_t kLeaf = 32;       // triangles compared pair by pair
constexpr std::size_t kFewMeshes = 16;  // meshes with boxes compared pair by pair
constexpr std::size_t kMostPairs = 10'000'000;
constexpr double kLeastDepth = 1e-3;  // overlap over the size of the smaller triangle

/// Triangles of a mesh in a part of space, with their common bounds.
struct Part {
  std::size_t mesh;
  std::optional<std::vector<std::uint32_t>> some;  ///< none: all
  Bounds box;
};

struct Face {
  std::size_t mesh, triangle;
};

Bounds box_of(const Corners& corners) {
  Bounds box;
  for (const Vec3d& p : corners) widen(box.low, box.high, p);
  return box;
}

/// True if two triangles in a plane overlap by more than `least`, by their separating axes.
bool overlap(const Corners& a, const Corners& b, const Vec3d& normal, double least) {
  const auto is_apart = [&](const Corners& one, const Corners& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& from = one[i];
      Vec3d outward = normalized(cross(one[(i + 1) % 3] - from, normal));
      if (dot(one[(i + 2) % 3] - from, outward) > 0) outward = -outward;
      if (std::ranges::all_of(other, [&](const Vec3d& p) { return dot(p - from, outward) > -least; }))
        return true;
    }
    return false;
  };
  return !is_apart(a, b) && !is_apart(b, a);
}

class Finder {
 public:
  Finder(const World& world, double rounding, const std::function<bool(std::size_t, std::size_t)>& is_settled,
         const std::function<bool(const CoplanarFaces&)>& found)
      : world_(world), is_settled_(is_settled), found_(found), margin_(rounding * world.diagonal) {
    for (const Bounds& box : world.boxes)
      reaches_.push_back(rounding * length(box.high - box.low) / world.unit);
  }

  void run() {
    std::vector<Part> parts;
    for (std::size_t m = 0; m < world_.meshes.size(); ++m)
      parts.push_back(
          {m,
           {},
           grown({into_world(world_, world_.boxes[m].low), into_world(world_, world_.boxes[m].high)})});
    search(std::move(parts));
  }

 private:
  std::size_t count_of(const Part& part) const {
    return part.some ? part.some->size() : world_.meshes[part.mesh].triangles.size();
  }

  Face face(const Part& part, std::size_t i) const { return {part.mesh, part.some ? (*part.some)[i] : i}; }

  Corners corners(const Face& face) const {
    const Mesh& mesh = world_.meshes[face.mesh];
    const auto& [a, b, c] = mesh.triangles[face.triangle];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
  }

  Bounds grown(const Bounds& box) const { return {box.low - Vec3d(margin_), box.high + Vec3d(margin_)}; }

  bool is_settled(std::size_t a, std::size_t b) {
    const auto [place, is_new] = settled_.try_emplace(std::minmax(a, b), false);
    if (is_new) place->second = is_settled_(place->first.first, place->first.second);
    return place->second;
  }

  /// Adds the triangles with a wanted box, if any, to `parts`.
  template <class IsWanted>
  void add_some(const Part& part, const IsWanted& is_wanted, std::vector<Part>& parts) const {
    Part kept{part.mesh, std::vector<std::uint32_t>(), {}};
    for (std::size_t i = 0; i < count_of(part); ++i) {
      const Bounds box = box_of(corners(face(part, i)));
      if (!is_wanted(box)) continue;
      kept.some->push_back(std::uint32_t(face(part, i).triangle));
      kept.box.low = component_min(kept.box.low, box.low);
      kept.box.high = component_max(kept.box.high, box.high);
    }
    kept.box = grown(kept.box);
    if (!kept.some->empty()) parts.push_back(std::move(kept));
  }

  /// Triangles in the box of another part.
  std::vector<Part> crowded(std::vector<Part> parts) {
    std::vector<Part> kept;
    for (const Part& part : parts) {
      std::vector<Bounds> others;
      for (const Part& other : parts)
        if (other.mesh != part.mesh && meet(part.box, other.box) && !is_settled(part.mesh, other.mesh))
          others.push_back(other.box);
      if (others.empty()) continue;
      add_some(
          part,
          [&](const Bounds& box) {
            return std::ranges::any_of(others, [&](const Bounds& other) { return meet(box, other); });
          },
          kept);
    }
    return kept;
  }

  /// Divides space in two until few triangles are left.
  void search(std::vector<Part> parts) {
    if (parts.size() > 1 && parts.size() <= kFewMeshes) parts = crowded(std::move(parts));
    if (parts.size() < 2) return;
    std::size_t count = 0;
    Bounds all;
    for (const Part& part : parts) {
      count += count_of(part);
      all.low = component_min(all.low, part.box.low);
      all.high = component_max(all.high, part.box.high);
    }
    if (count <= kLeaf) return compare(parts);
    const Vec3d size = all.high - all.low, middle = middle_of(parts, count);
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::ranges::sort(axes, std::greater(), [&](std::size_t axis) { return size[axis]; });
    for (const std::size_t axis : axes) {
      std::array<std::vector<Part>, 2> sides = divided(parts, axis, middle[axis]);
      if (!makes_progress(sides, count)) continue;
      parts.clear();
      for (std::vector<Part>& side : sides) search(std::move(side));
      return;
    }
    compare(parts);
  }

  /// Mean of the centres of some triangles.
  Vec3d middle_of(const std::vector<Part>& parts, std::size_t count) const {
    constexpr std::size_t kTested = 64;  // triangles per part
    Vec3d middle;
    for (const Part& part : parts) {
      const std::size_t own = count_of(part), tested = std::min(own, kTested);
      for (std::size_t i = 0; i < tested; ++i)
        for (const Vec3d& p : corners(face(part, i * own / tested)))
          middle += p * (double(own) / double(3 * tested * count));
    }
    return middle;
  }

  /// A triangle across the division is on both sides.
  std::array<std::vector<Part>, 2> divided(const std::vector<Part>& parts, std::size_t axis,
                                           double middle) const {
    std::array<std::vector<Part>, 2> sides;
    for (const Part& part : parts) {
      if (part.box.high[axis] < middle) {
        sides[0].push_back(part);
      } else if (part.box.low[axis] > middle) {
        sides[1].push_back(part);
      } else {
        add_some(
            part, [&](const Bounds& box) { return box.low[axis] <= middle + margin_; }, sides[0]);
        add_some(
            part, [&](const Bounds& box) { return box.high[axis] >= middle - margin_; }, sides[1]);
      }
    }
    return sides;
  }

  bool makes_progress(const std::array<std::vector<Part>, 2>& sides, std::size_t count) const {
    constexpr double kLargest = .8, kTogether = 1.3;  // triangles on a side, on both; over the count before
    std::array<double, 2> counts{};
    for (std::size_t i = 0; i < 2; ++i)
      for (const Part& part : sides[i]) counts[i] += double(count_of(part));
    return std::max(counts[0], counts[1]) <= kLargest * double(count) &&
           counts[0] + counts[1] <= kTogether * double(count);
  }

  void compare(const std::vector<Part>& parts) {
    for (std::size_t a = 0; a < parts.size(); ++a)
      for (std::size_t b = a + 1; b < parts.size(); ++b)
        for (std::size_t i = 0; i < count_of(parts[a]); ++i)
          for (std::size_t j = 0; j < count_of(parts[b]); ++j) {
            if (is_settled(parts[a].mesh, parts[b].mesh) || ++pairs_ > kMostPairs) break;
            compare(face(parts[a], i), face(parts[b], j));
          }
  }

  void compare(const Face& one, const Face& other) {
    const Corners a = corners(one), b = corners(other);
    const auto normal_of = [](const Corners& t) { return cross(t[1] - t[0], t[2] - t[0]); };
    const Vec3d na = normal_of(a), nb = normal_of(b);
    const double area_a = length(na), area_b = length(nb);  // doubled
    if (!(std::min(area_a, area_b) > 0)) return;
    const Corners &small = area_a < area_b ? a : b, &large = area_a < area_b ? b : a;
    const Vec3d normal = area_a < area_b ? nb / area_b : na / area_a;
    const double reach = std::min(reaches_[one.mesh], reaches_[other.mesh]);
    if (std::ranges::any_of(small,
                            [&](const Vec3d& p) { return std::abs(dot(p - large[0], normal)) > reach; }))
      return;
    const double least = std::max(reach, kLeastDepth * std::sqrt(std::min(area_a, area_b)));
    if (overlap(a, b, normal, least) &&
        found_({{one.mesh, other.mesh}, {na / area_a, nb / area_b}, small[0]}))
      settled_[{one.mesh, other.mesh}] = true;
  }

  const World& world_;
  const std::function<bool(std::size_t, std::size_t)>& is_settled_;
  const std::function<bool(const CoplanarFaces&)>& found_;
  double margin_;
  std::vector<double> reaches_;  // one per mesh, world units
  std::map<std::pair<std::size_t, std::size_t>, bool> settled_;
  std::size_t pairs_ = 0;
};

}  // namespace

void find_coplanar_faces(const World& world, double rounding,
                         const std::function<bool(std::size_t, std::size_t)>& is_settled,
                         const std::function<bool(const CoplanarFaces&)>& found) {
  if (world.meshes.size() > 1) Finder(world, rounding, is_settled, found).run();
}

}  // namespace opaline
