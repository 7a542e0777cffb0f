// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of meshes share: small meshes, mesh files, and one call to make them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "../core/scratch_folder.h"
#include "geometry/make_mesh.h"
#include "opaline/error.h"

namespace opaline::mesh_test {

struct Soup {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A cube of side 2 h around c, wound outward: 8 vertices, 12 triangles.
inline Soup cube(double h = 1, const Vec3d& c = {}) {
  Soup soup;
  for (int i = 0; i < 8; ++i)
    soup.positions.push_back(c + Vec3d(i & 1 ? h : -h, i & 2 ? h : -h, i & 4 ? h : -h));
  soup.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return soup;
}

/// The built-in sphere's triangles.
inline Soup sphere(double radius = 1) {
  Shape shape;
  shape.source = SphereShape{{}, radius};
  const Mesh mesh = make_mesh(shape).mesh;
  return {mesh.positions, mesh.triangles};
}

inline void append(Soup& soup, const Soup& more) {
  const auto first = std::uint32_t(soup.positions.size());
  soup.positions.insert(soup.positions.end(), more.positions.begin(), more.positions.end());
  for (const auto& [a, b, c] : more.triangles) soup.triangles.push_back({first + a, first + b, first + c});
}

inline Soup flipped(Soup soup) {
  for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
  return soup;
}

inline std::string obj(const Soup& soup) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3d& p : soup.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& [a, b, c] : soup.triangles) text << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  return text.str();
}

/// Faces and, at their corners, the normals of a function.
inline std::string obj_with_normals(const Soup& soup, const std::function<Vec3d(const Vec3d&)>& normal) {
  std::string text = obj({soup.positions, {}});
  for (const Vec3d& p : soup.positions) {
    const Vec3d n = normal(p);
    text += "vn " + std::to_string(n.x) + ' ' + std::to_string(n.y) + ' ' + std::to_string(n.z) + '\n';
  }
  for (const auto& triangle : soup.triangles) {
    text += 'f';
    for (const std::uint32_t v : triangle) {
      const std::string number = std::to_string(v + 1);
      text += ' ' + number + "//" + number;
    }
    text += '\n';
  }
  return text;
}

inline Shape file_shape(const std::string& path, bool fill_holes = false) {
  Shape shape;
  shape.name = "test";
  MeshFile file;
  file.path = path;
  file.fill_holes = fill_holes;
  shape.source = file;
  return shape;
}

/// Writes the bytes to a file of this name and makes its mesh.
inline CheckedMesh load(const std::string& name, const std::string& bytes, bool fill_holes = false,
                        NormalMode normals = NormalMode::smooth) {
  const ScratchFolder folder;
  put_bytes(folder.file(name), bytes);
  Shape shape = file_shape(folder.file(name), fill_holes);
  shape.normals = normals;
  return make_mesh(shape);
}

inline CheckedMesh load(const Soup& soup, bool fill_holes = false) {
  return load("soup.obj", obj(soup), fill_holes);
}

/// what() of the Error{bad_input} that loading the bytes throws; "" if it throws none.
inline std::string load_error(const std::string& name, const std::string& bytes) {
  try {
    load(name, bytes);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    return error.what();
  }
  return {};
}

inline double signed_volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(mesh.positions[a], cross(mesh.positions[b], mesh.positions[c]));
  return sum / 6;
}

/// The triangles as a set, each starting at its lowest vertex: equal for equal meshes.
inline std::set<std::array<std::uint32_t, 3>> triangle_set(const Mesh& mesh) {
  std::set<std::array<std::uint32_t, 3>> set;
  for (auto triangle : mesh.triangles) {
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    set.insert(triangle);
  }
  return set;
}

inline bool warns(const MeshReport& report, const std::string& words) {
  for (const std::string& warning : report.warnings)
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

/// The bytes of a value as they lie in memory (the tests run on little-endian machines).
template <class T>
std::string raw(const T& value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

inline std::string binary_stl(const Soup& soup) {
  std::string bytes(80, '\0');
  bytes += raw(std::uint32_t(soup.triangles.size()));
  for (const auto& triangle : soup.triangles) {
    bytes += std::string(12, '\0');
    for (const std::uint32_t v : triangle) bytes += raw(Vec3f(soup.positions[v]));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

}  // namespace opaline::mesh_test
