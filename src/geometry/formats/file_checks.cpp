// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/file_checks.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "geometry/doubled_polygons.h"

namespace opaline {
namespace {

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
