// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/subdivide.h"

#include <utility>

#include "geometry/topology.h"

namespace opaline {
namespace {

/// Smoothed vertices, and those in the middle of edges.
class Refinement {
 public:
  Refinement(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles)
      : old_(positions), triangles_(triangles), middles_(3 * triangles.size()) {
    const EdgeTable edges(triangles, positions.size());
    std::vector<Star> stars(positions.size());
    edges.for_each([&](std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> corners) {
      for (const std::uint32_t corner : corners)
        middles_[corner] = std::uint32_t(old_.size() + added_.size());
      added_.push_back(middle(a, b, corners));
      add(stars[a], old_[b], corners.size() != 2);
      add(stars[b], old_[a], corners.size() != 2);
    });
    positions_.reserve(old_.size() + added_.size());
    for (std::size_t v = 0; v < old_.size(); ++v) positions_.push_back(smoothed(old_[v], stars[v]));
    positions_.insert(positions_.end(), added_.begin(), added_.end());
  }

  std::vector<Vec3d> take_positions() { return std::move(positions_); }
  /// Vertex in the middle of the edge from a triangle's corner to the next.
  std::uint32_t middle_of(std::size_t triangle, std::size_t corner) const {
    return middles_[3 * triangle + corner];
  }

 private:
  /// Neighbours of a vertex; those along curves by themselves.
  struct Star {
    Vec3d sum, on_curves;
    int count = 0, curves = 0;
  };

  static void add(Star& star, const Vec3d& neighbour, bool is_curve) {
    star.sum += neighbour;
    ++star.count;
    if (!is_curve) return;
    star.on_curves += neighbour;
    ++star.curves;
  }

  Vec3d middle(std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> corners) const {
    if (corners.size() != 2) return (old_[a] + old_[b]) / 2.0;
    Vec3d opposite;
    for (const std::uint32_t corner : corners) opposite += old_[triangles_[corner / 3][(corner % 3 + 2) % 3]];
    return (old_[a] + old_[b]) * (3. / 8) + opposite / 8.0;
  }

  /// Ends of curves, and where more than two meet, stay.
  static Vec3d smoothed(const Vec3d& vertex, const Star& star) {
    if (star.count == 0) return vertex;
    if (star.curves > 0) return star.curves == 2 ? vertex * .75 + star.on_curves / 8.0 : vertex;
    const double weight = star.count == 3 ? 3. / 16 : 3. / (8 * star.count);
    return vertex * (1 - star.count * weight) + star.sum * weight;
  }

  const std::vector<Vec3d>& old_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::uint32_t> middles_;  // by corner
  std::vector<Vec3d> added_, positions_;
};

/// Corners of the four triangles, from values at the corners of one: three at its corners, then the middle.
template <class Value, class Mean>
std::array<std::array<Value, 3>, 4> quarters(const std::array<Value, 3>& at, const Mean& mean) {
  const Value ab = mean(at[0], at[1]), bc = mean(at[1], at[2]), ca = mean(at[2], at[0]);
  return {{{at[0], ab, ca}, {ab, at[1], bc}, {ca, bc, at[2]}, {ab, bc, ca}}};
}

template <class Value, class Mean>
void quarter(std::vector<std::array<Value, 3>>& corners, const Mean& mean) {
  std::vector<std::array<Value, 3>> finer;
  finer.reserve(4 * corners.size());
  for (const std::array<Value, 3>& at : corners)
    for (const std::array<Value, 3>& part : quarters(at, mean)) finer.push_back(part);
  corners = std::move(finer);
}

/// Triangles with fewer than three different corners would make curves of the edges beside them; so would doubles.
void drop_collapsed_and_duplicates(SourceMesh& mesh) {
  const std::vector<bool> duplicate =
      find_duplicates(mesh.triangles, EdgeTable(mesh.triangles, mesh.positions.size()));
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a || duplicate[t]) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[t];
    if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[t];
    if (!mesh.tangents.empty()) mesh.tangents[kept] = mesh.tangents[t];
    ++kept;
  }
  mesh.collapsed += mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  if (!mesh.colors.empty()) mesh.colors.resize(kept);
  if (!mesh.tangents.empty()) mesh.tangents.resize(kept);
}

}  // namespace

SourceMesh subdivided(SourceMesh mesh) {
  const std::vector<std::uint32_t> site = weld(mesh.positions);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& v : triangle) v = site[v];
  drop_collapsed_and_duplicates(mesh);
  Refinement refinement(mesh.positions, mesh.triangles);
  std::vector<Triangle> finer;
  finer.reserve(4 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const std::uint32_t ab = refinement.middle_of(t, 0), bc = refinement.middle_of(t, 1),
                        ca = refinement.middle_of(t, 2);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh.positions = refinement.take_positions();
  mesh.triangles = std::move(finer);
  mesh.normals.clear();
  mesh.smoothing = {};
  using Uv = std::array<float, 2>;
  quarter(mesh.uvs, [](const Uv& a, const Uv& b) { return Uv{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; });
  quarter(mesh.colors, [](const RgbF& a, const RgbF& b) { return (a + b) * .5f; });
  quarter(mesh.tangents, [](const auto& a, const auto& b) {
    auto mean = a;
    mean.direction = normalized(a.direction + b.direction);
    return mean;
  });
  return mesh;
}

}  // namespace opaline
