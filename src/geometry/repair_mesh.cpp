// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/repair_mesh.h"

// Before CGAL's headers: their functions in boost::detail would hide those for pointers.
#include <boost/pending/disjoint_sets.hpp>
//
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>  // is_polygon_soup_a_polygon_mesh
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <algorithm>
#include <exception>
#include <map>
#include <numbers>

namespace opaline {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using HalfedgeMesh = OpenMesh::TriMesh;  // coordinates in double
using Halfedge = OpenMesh::HalfedgeHandle;

// Number of a hole's edges up to which all triangulations are compared, in cubic time. The faster search
// within a Delaunay tetrahedralization breaks ties by addresses, so its result is not reproducible.
constexpr std::size_t largest_cubic_hole = 500;
// Number of edges up to which a fan replaces a triangulation not found by CGAL.
constexpr std::size_t kFewEdges = 8;

/// Edges that hang together, around one hole or several that touch.
struct Rim {
  double length = 0;
  double fan = 0;  ///< area of the triangles from one vertex to each edge
  std::size_t edges = 0;

  /// Upper bound of the area that closes it: a circle, by the isoperimetric inequality, or the fan.
  double area() const { return std::min(length * length / (4 * std::numbers::pi), fan); }
};

/// The edges where half-edges end.
struct Borders {
  std::vector<Edge> open;       ///< edges of one triangle, ascending
  std::vector<char> is_beside;  ///< one per vertex: at such an edge
};

/// Half-edges end at open edges, and where orient_polygon_soup cuts: along edges of more than two triangles, or of two with
/// opposite winding.
Borders borders_of(const std::vector<Triangle>& triangles, const EdgeTable& edges, std::size_t vertices) {
  Borders borders{{}, std::vector<char>(vertices)};
  const auto ascends = [&](std::uint32_t triangle, std::uint32_t low, std::uint32_t high) {
    const auto& [a, b, c] = triangles[triangle];
    return (a == low && b == high) || (b == low && c == high) || (c == low && a == high);
  };
  edges.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const std::uint32_t> corners) {
    if (corners.size() == 1) borders.open.push_back({low, high});
    if (corners.size() == 2 && ascends(corners[0] / 3, low, high) != ascends(corners[1] / 3, low, high))
      return;
    borders.is_beside[low] = borders.is_beside[high] = true;
  });
  return borders;
}

/// Triangles with a vertex at a border, in their order. Holes have all their neighbours there, and where others are missing
/// no vertex is at a border.
std::vector<Triangle> triangles_beside(const Borders& borders, const std::vector<Triangle>& triangles) {
  std::vector<Triangle> beside;
  std::ranges::copy_if(triangles, std::back_inserter(beside), [&](const Triangle& triangle) {
    return std::ranges::any_of(triangle, [&](std::uint32_t v) { return borders.is_beside[v] != 0; });
  });
  return beside;
}

class HoleFiller {
 public:
  HoleFiller(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, Borders borders,
             bool has_inside)
      : positions_(positions), borders_(std::move(borders)), has_inside_(has_inside) {
    build(triangles_beside(borders_, triangles));
  }

  HoleFilling run(FillHoles which) {
    std::vector<Halfedge> borders;
    pmp::extract_boundary_cycles(mesh_, std::back_inserter(borders));
    for (const Halfedge border : borders)
      if (borders_.is_beside[original(mesh_.from_vertex_handle(border))]) fill(border);
    if (which == FillHoles::if_small && !result_.unfilled.empty()) return {};
    return std::move(result_);
  }

 private:
  /// Half-edges require manifold edges and vertices: orient_polygon_soup doubles others; original_ maps back.
  void build(const std::vector<Triangle>& triangles) {
    std::vector<std::uint32_t> compact(positions_.size(), 0xffffffff);
    std::vector<Point> points;
    std::vector<std::array<std::size_t, 3>> polygons;
    polygons.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
      auto& polygon = polygons.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = triangle[k];
        if (compact[v] == 0xffffffff) {
          compact[v] = std::uint32_t(points.size());
          points.emplace_back(positions_[v].x, positions_[v].y, positions_[v].z);
          original_.push_back(v);
        }
        polygon[k] = compact[v];
      }
    }
    if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) {
      const std::size_t before = points.size();
      pmp::orient_polygon_soup(points, polygons);
      trace_back(points, before);
    }
    // CGAL's conversion of a soup to OpenMesh rounds points to float
    for (const Point& p : points) mesh_.add_vertex({p.x(), p.y(), p.z()});
    for (const auto& [a, b, c] : polygons)
      mesh_.add_face(mesh_.vertex_handle(unsigned(a)), mesh_.vertex_handle(unsigned(b)),
                     mesh_.vertex_handle(unsigned(c)));
  }

  void trace_back(const std::vector<Point>& points, std::size_t before) {
    std::map<Point, std::uint32_t> by_position;  // positions are unique: the mesh is welded
    if (points.size() == before) return;
    for (std::size_t i = 0; i < before; ++i) by_position.emplace(points[i], original_[i]);
    for (std::size_t i = before; i < points.size(); ++i) original_.push_back(by_position.at(points[i]));
  }

  std::uint32_t original(OpenMesh::VertexHandle v) const { return original_[std::size_t(v.idx())]; }

  /// True if every edge of the border is open in the mesh as it was, not cut where three triangles meet.
  bool is_hole(Halfedge border, std::size_t& edges) const {
    bool open = true;
    for (const Halfedge h : CGAL::halfedges_around_face(border, mesh_)) {
      const auto [low, high] =
          std::minmax({original(mesh_.from_vertex_handle(h)), original(mesh_.to_vertex_handle(h))});
      open &= std::ranges::binary_search(borders_.open, Edge{low, high});
      ++edges;
    }
    return open;
  }

  void fill(Halfedge border) {
    std::size_t edges = 0;
    if (!is_hole(border, edges) && !has_inside_) {
      result_.unfilled.push_back(edges);
      return;
    }
    std::vector<Triangle> patch = edges > 3 ? smallest_patch(border, edges) : fan(border);
    if (patch.empty() && edges <= kFewEdges) patch = fan(border);
    if (patch.empty()) {
      result_.unfilled.push_back(edges);
      return;
    }
    ++result_.filled;
    result_.triangles.insert(result_.triangles.end(), patch.begin(), patch.end());
  }

  /// Empty: CGAL finds none, as for vertices on a line.
  std::vector<Triangle> smallest_patch(Halfedge border, std::size_t edges) {
    std::vector<OpenMesh::FaceHandle> faces;
    try {
      const auto options = CGAL::parameters::use_delaunay_triangulation(edges > largest_cubic_hole)
                               .do_not_use_cubic_algorithm(edges > largest_cubic_hole);
#if CGAL_VERSION_MAJOR >= 6
      pmp::triangulate_hole(mesh_, border, options.face_output_iterator(std::back_inserter(faces)));
#else
      pmp::triangulate_hole(mesh_, border, std::back_inserter(faces), options);
#endif
    } catch (const std::exception&) {
      return {};  // CGAL's assertion on degenerate holes
    }
    std::vector<Triangle> patch;
    for (const auto face : faces) {
      Triangle& triangle = patch.emplace_back();
      std::size_t k = 0;
      for (const auto v : mesh_.fv_range(face)) triangle[k++] = original(v);
    }
    return patch;
  }

  /// Triangles from the first vertex to each edge.
  std::vector<Triangle> fan(Halfedge border) const {
    std::vector<std::uint32_t> around;
    for (const Halfedge h : CGAL::halfedges_around_face(border, mesh_))
      around.push_back(original(mesh_.from_vertex_handle(h)));
    std::vector<Triangle> patch;
    for (std::size_t i = 2; i < around.size(); ++i) patch.push_back({around[0], around[i - 1], around[i]});
    return patch;
  }

  const std::vector<Vec3d>& positions_;
  Borders borders_;
  bool has_inside_;
  std::vector<std::uint32_t> original_;  // source vertex of each vertex of mesh_
  HalfedgeMesh mesh_;
  HoleFilling result_;
};

}  // namespace

bool has_small_holes(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                     const std::vector<Edge>& open_edges) {
  constexpr double kLargest = 0.05, kLargestSum = 0.1;  // fraction of the mesh's area
  boost::disjoint_sets_with_storage<> touching(positions.size());
  for (const auto& [a, b] : open_edges) touching.union_set(a, b);
  std::map<std::size_t, Rim> rims;  // by one of their vertices
  for (const auto& [a, b] : open_edges) {
    const std::size_t apex = touching.find_set(a);
    Rim& rim = rims[apex];
    rim.length += length(positions[b] - positions[a]);
    rim.fan += 0.5 * length(cross(positions[a] - positions[apex], positions[b] - positions[apex]));
    ++rim.edges;
  }
  double area = 0, sum = 0, largest = 0;
  for (const auto& [a, b, c] : triangles)
    area += 0.5 * length(cross(positions[b] - positions[a], positions[c] - positions[a]));
  for (const auto& [apex, rim] : rims) {
    if (rim.edges > largest_cubic_hole) return false;
    largest = std::max(largest, rim.area());
    sum += rim.area();
  }
  return largest < kLargest * area && sum < kLargestSum * area;
}

HoleFilling fill_holes(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       const EdgeTable& edges, FillHoles which, bool has_inside) {
  return HoleFiller(positions, triangles, borders_of(triangles, edges, positions.size()), has_inside)
      .run(which);
}

}  // namespace opaline
