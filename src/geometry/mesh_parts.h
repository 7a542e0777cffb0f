// SPDX-License-Identifier: GPL-3.0-or-later
// Connected parts of a mesh, and measures distinguishing inside and outside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// Triangles with their current winding and the file's normals.
struct WoundMesh {
  const std::vector<Vec3d>& positions;
  const std::vector<Triangle>& triangles;
  const std::vector<Vec3f>& normals;  ///< as SourceMesh::normals
};

/// Connected parts, each with consistent winding.
struct MeshParts {
  enum class Kind : unsigned char {
    closed,  ///< an even number of its triangles meets in each of its edges
    open,
    ignored  ///< one-sided, or open where open parts stay as they are
  };
  struct RimEdge {
    std::uint32_t part, from, to;  ///< as its triangle has it
  };
  std::vector<std::uint32_t> of;  ///< one per triangle: its part
  std::vector<Kind> kinds;        ///< one per part
  std::vector<RimEdge> rims;      ///< edges of the open parts' holes
};

/// Sums; areas are doubled, volumes sextupled.
struct PartMeasures {
  Bounds box;
  double volume = 0;      ///< signed; holes closed by triangles to the middles of their rims
  double magnitudes = 0;  ///< sum of the absolute terms of the volume
  // Open parts only:
  double area = 0, hole_area = 0;
  Vec3d area_vector;  ///< sum of the triangles' normals times their areas
  double area_for_normals = 0, area_against_normals = 0;
};

class MeasuredParts {
 public:
  MeasuredParts(const WoundMesh& mesh, const MeshParts& parts);

  const PartMeasures& operator[](std::size_t part) const { return measures_[part]; }

  /// Triangles of a part, ascending.
  std::span<const std::uint32_t> triangles(std::size_t part) const;

  /// True if a part, with its holes closed, is around the larger half of some points of another part.
  bool contains(std::size_t outer, std::size_t inner) const;

  /// The common volume of parts, with their rims joined to the middle of their area, and its magnitudes.
  PartMeasures common_measures(std::span<const std::uint32_t> parts) const;

 private:
  struct Corners {
    Vec3d a, b, c;
  };
  Corners corners(std::size_t t) const;
  void group_triangles();
  void measure_areas(std::size_t part);
  void close_holes();
  void measure_volume(std::size_t part);
  std::span<const Corners> closing(std::size_t part) const;
  bool contains_point(std::size_t outer, const Vec3d& point) const;

  const WoundMesh& mesh_;
  const MeshParts& parts_;
  std::vector<PartMeasures> measures_;
  std::vector<std::uint32_t> first_, order_;  // triangles by part
  std::vector<std::uint32_t> first_closing_;  // by part
  std::vector<Corners> closing_;              // triangles closing holes, with the part's winding
};

}  // namespace opaline
