// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/file_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include "core/random.h"
#include "geometry/cut_polygons.h"
#include "geometry/topology.h"

namespace opaline {
namespace {

/// Corners of a polygon from its lowest vertex towards the lower of its neighbours: equal for all polygons
/// with the same edges.
class Circuit {
 public:
  void read(const std::vector<Triangle>& triangles, const Fan& fan, const std::vector<std::uint32_t>& same) {
    const Triangle& first = triangles[fan.first];
    corners_ = {same[first[0]], same[first[1]]};
    for (std::size_t t = 0; t < fan.count; ++t) corners_.push_back(same[triangles[fan.first + t][2]]);
    start_ = std::size_t(std::ranges::min_element(corners_) - corners_.begin());
    const std::size_t last = size() - 1;
    is_forward_ = corners_[(start_ + 1) % size()] <= corners_[(start_ + last) % size()];
  }

  std::size_t size() const { return corners_.size(); }
  bool is_forward() const { return is_forward_; }

  /// Polygon corner at an index of the circuit, and the inverse.
  std::uint32_t corner(std::size_t place) const {
    return std::uint32_t((is_forward_ ? start_ + place : start_ + size() - place) % size());
  }
  std::size_t place(std::size_t corner) const {
    return (is_forward_ ? corner + size() - start_ : start_ + size() - corner) % size();
  }

  std::uint64_t hash() const {
    std::uint64_t hash = size();
    for (std::size_t i = 0; i < size(); ++i) hash = hash_bits(hash, corners_[corner(i)]);
    return hash;
  }

  bool has_edges_of(const Circuit& other) const {
    if (size() != other.size()) return false;
    for (std::size_t i = 0; i < size(); ++i)
      if (corners_[corner(i)] != other.corners_[other.corner(i)]) return false;
    return true;
  }

 private:
  std::vector<std::uint32_t> corners_;  // by their first vertices of equal position
  std::size_t start_ = 0;
  bool is_forward_ = true;
};

Triangle sorted(Triangle triangle) {
  std::ranges::sort(triangle);
  return triangle;
}

class DoubleCutter {
 public:
  DoubleCutter(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
               const std::vector<Fan>& fans, const std::vector<Recut>& cuts)
      : triangles_(triangles), fans_(fans), cuts_(cuts), same_(weld(positions)) {}

  std::vector<Recut> run() {
    find_given_triangles();
    std::vector<std::pair<std::uint64_t, std::uint32_t>> by_hash;
    by_hash.reserve(fans_.size());
    for (std::uint32_t f = 0; f < fans_.size(); ++f) {
      second_.read(triangles_, fans_[f], same_);
      by_hash.emplace_back(second_.hash(), f);
    }
    std::ranges::sort(by_hash);
    for (std::size_t begin = 0, end = 0; begin < by_hash.size(); begin = end) {
      while (end < by_hash.size() && by_hash[end].first == by_hash[begin].first) ++end;
      cut_as_given(by_hash[begin].second);
      for (std::size_t i = begin + 1; i < end; ++i) cut_alike(by_hash[begin].second, by_hash[i].second);
    }
    return merged();
  }

 private:
  /// Triangles outside all polygons.
  void find_given_triangles() {
    std::size_t next = 0;
    for (std::size_t t = 0; t < triangles_.size();) {
      if (next < fans_.size() && fans_[next].first == t) {
        t += fans_[next++].count;
        continue;
      }
      const auto [a, b, c] = triangles_[t++];
      given_.push_back(sorted({same_[a], same_[b], same_[c]}));
    }
    std::ranges::sort(given_);
  }

  bool is_given(std::uint32_t f, const Triangle& corners) const {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = same_[vertex(f, corners[k])];
    return std::ranges::binary_search(given_, sorted(triangle));
  }

  std::uint32_t vertex(std::uint32_t f, std::uint32_t corner) const {
    return corner == 0   ? triangles_[fans_[f].first][0]
           : corner == 1 ? triangles_[fans_[f].first][1]
                         : triangles_[fans_[f].first + corner - 2][2];
  }

  void cut_as_given(std::uint32_t f) {
    if (fans_[f].count != 2 || given_.empty()) return;
    for (const std::vector<Triangle>& cut :
         {std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}, std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}}})
      if (is_given(f, cut[0]) && is_given(f, cut[1])) new_cuts_[f] = cut;
  }

  std::vector<Triangle> cut_of(std::uint32_t f) const {
    if (const auto found = new_cuts_.find(f); found != new_cuts_.end()) return found->second;
    const auto cut =
        std::ranges::lower_bound(cuts_, fans_[f].first, {}, [](const Recut& c) { return c.fan.first; });
    if (cut != cuts_.end() && cut->fan.first == fans_[f].first) return cut->corners;
    std::vector<Triangle> fan;
    for (std::uint32_t i = 2; i < fans_[f].count + 2; ++i) fan.push_back({0, i - 1, i});
    return fan;
  }

  void cut_alike(std::uint32_t first, std::uint32_t second) {
    first_.read(triangles_, fans_[first], same_);
    second_.read(triangles_, fans_[second], same_);
    if (!second_.has_edges_of(first_)) return;
    std::vector<Triangle> cut = cut_of(first);
    for (Triangle& triangle : cut) {
      for (std::uint32_t& corner : triangle) corner = second_.corner(first_.place(corner));
      if (first_.is_forward() != second_.is_forward()) std::swap(triangle[1], triangle[2]);
    }
    new_cuts_[second] = std::move(cut);
  }

  /// The given cuts and the new ones, in the order of the fans.
  std::vector<Recut> merged() {
    std::vector<Recut> merged;
    auto old = cuts_.begin();
    for (auto& [f, cut] : new_cuts_) {
      for (; old != cuts_.end() && old->fan.first < fans_[f].first; ++old) merged.push_back(*old);
      if (old != cuts_.end() && old->fan.first == fans_[f].first) ++old;
      merged.push_back({fans_[f], std::move(cut)});
    }
    merged.insert(merged.end(), old, cuts_.end());
    return merged;
  }

  const std::vector<Triangle>& triangles_;
  const std::vector<Fan>& fans_;
  const std::vector<Recut>& cuts_;
  std::vector<std::uint32_t> same_;
  std::vector<Triangle> given_;                              // sorted
  std::map<std::uint32_t, std::vector<Triangle>> new_cuts_;  // by the numbers of fans
  Circuit first_, second_;
};

/// Unifies the triangulations of polygons with the same corners, in any rotation or direction, so their
/// triangles become duplicates. A quad also given as two triangles uses their diagonal.
/// in    cuts: of cut_concave_polygons, in the order of the fans; equal positions are one corner
/// out   cuts, with those of later polygons added or replaced
void cut_doubles_alike(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       const std::vector<Fan>& fans, std::vector<Recut>& cuts) {
  if (!fans.empty()) cuts = DoubleCutter(positions, triangles, fans, cuts).run();
}

bool is_in_range(const Vec3d& v) {
  return std::abs(v.x) < coordinate_limit && std::abs(v.y) < coordinate_limit &&
         std::abs(v.z) < coordinate_limit;  // false for NaN as well
}

}  // namespace

void VertexCheck::check(const Vec3d& p, std::size_t index, int line) {
  if (is_in_range(p)) return;
  if (bad_++ > 0) return;
  first_index_ = index;
  first_line_ = line;
  first_ = p;
}

void VertexCheck::throw_if_any(const std::string& path) const {
  if (bad_ == 0) return;
  char got[160];
  std::snprintf(got, sizeof got, "(%g, %g, %g)", first_.x, first_.y, first_.z);
  const std::string count = bad_ == 1 ? "1 vertex has" : std::to_string(bad_) + " vertices have";
  throw bad_line(path, first_line_,
                 count + " a coordinate that is not finite or too large, the first is vertex " +
                     std::to_string(first_index_ + 1),
                 "finite coordinates below 1e18", got);
}

Vec3f usable_normal(const Vec3d& normal) {
  return is_in_range(normal) ? Vec3f(normal) : Vec3f();
}

std::vector<Recut> cut_polygons(const std::string& path, SourceMesh& mesh, const std::vector<Fan>& fans) {
  PolygonCuts result = cut_concave_polygons(mesh.positions, mesh.triangles, fans);
  cut_doubles_alike(mesh.positions, mesh.triangles, fans, result.cuts);
  recut(result.cuts, mesh.triangles);
  if (result.crossing > 0)
    mesh.warnings.push_back(path + ": " +
                            (result.crossing == 1
                                 ? "1 face crosses itself; its"
                                 : std::to_string(result.crossing) + " faces cross themselves; their") +
                            " triangles overlap");
  return std::move(result.cuts);
}

void give_uvs(SourceMesh& mesh, const std::vector<std::array<float, 2>>& uvs) {
  if (uvs.empty()) return;
  mesh.uvs.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) mesh.uvs.push_back({uvs[a], uvs[b], uvs[c]});
}

Error bad_line(const std::string& path, int line, std::string message, std::string expected,
               std::string got) {
  return Error(ErrorKind::bad_input, path, line, 0, std::move(message), std::move(expected), std::move(got));
}

void require_faces(const std::string& path, std::size_t vertices, std::size_t faces) {
  if (vertices == 0) throw bad_file(path, "the mesh has no vertices", "at least three", "none");
  if (faces == 0) throw bad_file(path, "the mesh has no faces", "at least one", "none");
}
}  // namespace opaline
