// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/builtin_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "opaline/error.h"

namespace opaline {
namespace {

void require_positive(double value, const char* what, const std::string& name) {
  if (std::isfinite(value) && value > 0) return;
  throw bad_file(name, std::string("bad ") + what, "a finite number above 0", std::to_string(value));
}

void add_quad(SourceMesh& mesh, const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
  const auto first = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {corner, corner + u, corner + u + v, corner + v});
  mesh.normals.insert(mesh.normals.end(), 4, Vec3f(normalized(cross(normalized(u), normalized(v)))));
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Unit vectors of an icosahedron with recursively quartered triangles.
class Icosphere {
 public:
  explicit Icosphere(int levels) {
    constexpr double t = std::numbers::phi;
    for (const double s : {-1.0, 1.0})
      for (const double r : {-t, t}) {
        vertices.push_back(normalized(Vec3d(s, r, 0)));
        vertices.push_back(normalized(Vec3d(0, s, r)));
        vertices.push_back(normalized(Vec3d(r, 0, s)));
      }
    hull();
    for (int level = 0; level < levels; ++level) cut();
  }

  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;

 private:
  /// The twenty triples of vertices one edge apart.
  void hull() {
    const auto near = [&](std::uint32_t a, std::uint32_t b) { return dot(vertices[a], vertices[b]) > 0.4; };
    for (std::uint32_t a = 0; a < 12; ++a)
      for (std::uint32_t b = a + 1; b < 12; ++b)
        for (std::uint32_t c = b + 1; c < 12; ++c) {
          if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
          const bool outward = dot(vertices[a], cross(vertices[b], vertices[c])) > 0;
          triangles.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
        }
  }

  void cut() {
    struct Middle {
      std::uint32_t other, vertex;
    };
    std::vector<std::vector<Middle>> middles(vertices.size());  // by lower vertex of an edge
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      std::vector<Middle>& known = middles[std::min(a, b)];
      const auto at = std::ranges::find(known, std::max(a, b), &Middle::other);
      if (at != known.end()) return at->vertex;
      known.push_back({std::max(a, b), std::uint32_t(vertices.size())});
      vertices.push_back(normalized(vertices[a] + vertices[b]));
      return known.back().vertex;
    };
    std::vector<Triangle> finer;
    finer.reserve(4 * triangles.size());
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
};

}  // namespace

SourceMesh tessellate(const SphereShape& sphere, const std::string& name) {
  require_positive(sphere.radius, "radius of a sphere", name);
  Icosphere unit(sphere.fineness);
  SourceMesh mesh;
  for (const Vec3d& direction : unit.vertices) {
    mesh.positions.push_back(sphere.center + sphere.radius * direction);
    mesh.normals.push_back(Vec3f(direction));
  }
  mesh.triangles = std::move(unit.triangles);
  return mesh;
}

SourceMesh tessellate(const BoxShape& box, const std::string& name) {
  const Vec3d size = box.high - box.low;
  require_positive(size.x, "x extent of a box", name);
  require_positive(size.y, "y extent of a box", name);
  require_positive(size.z, "z extent of a box", name);
  SourceMesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d u, v, w;
    w[axis] = size[axis];
    u[(axis + 1) % 3] = size[(axis + 1) % 3];
    v[(axis + 2) % 3] = size[(axis + 2) % 3];
    add_quad(mesh, box.low + w, u, v);
    add_quad(mesh, box.low, v, u);
  }
  // sums of the corners may round differently from face to face: snap them, so the box is closed
  for (Vec3d& p : mesh.positions)
    for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] == box.low[i] ? box.low[i] : box.high[i];
  return mesh;
}

SourceMesh tessellate(const SlabShape& slab, const std::string& name) {
  require_positive(slab.width, "width of a slab", name);
  require_positive(slab.depth, "depth of a slab", name);
  require_positive(slab.thickness, "thickness of a slab", name);
  const Vec3d half = Vec3d(slab.width, slab.thickness, slab.depth) / 2.0;
  return tessellate(BoxShape{slab.center - half, slab.center + half}, name);
}

SourceMesh tessellate(const QuadShape& quad, const std::string& name) {
  require_positive(length(quad.u), "first side of a quad", name);
  require_positive(length(quad.v), "second side of a quad", name);
  SourceMesh mesh;
  add_quad(mesh, quad.corner, quad.u, quad.v);
  return mesh;
}

SourceMesh tessellate(const TorusShape& torus, const std::string& name) {
  require_positive(torus.major_radius, "major radius of a torus", name);
  require_positive(torus.minor_radius, "minor radius of a torus", name);
  const std::uint32_t around = 4u << torus.fineness, across = 2u << torus.fineness;
  constexpr double turn = 2 * std::numbers::pi;
  SourceMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    const Vec3d outward{std::cos(turn * i / around), 0, -std::sin(turn * i / around)};
    for (std::uint32_t j = 0; j < across; ++j) {
      const Vec3d normal = outward * std::cos(turn * j / across) + Vec3d(0, std::sin(turn * j / across), 0);
      mesh.positions.push_back(torus.center + outward * torus.major_radius + normal * torus.minor_radius);
      mesh.normals.push_back(Vec3f(normal));
      const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = i1 * across + j, c = i1 * across + j1, d = i * across + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace opaline
