// SPDX-License-Identifier: GPL-3.0-or-later
// Several surface points per sample, spread evenly over its Voronoi cell.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/ray_scene.h"
#include "sampling/sample_surface.h"

namespace opaline {

/// True if a mesh of the world has samples, by its index; meshes beyond the end have none.
std::vector<bool> meshes_of(std::span<const SurfaceSample> samples);

/// Points of the cells of a batch of samples, computed together: add the samples, project, read the points. A
/// cell is the surface nearer to its sample than to any other on surfaces not facing away, as in the area
/// measurement of sampling. Where two sheets are closer than the samples, it includes parts of both.
class CellPoints {
 public:
  static constexpr std::uint32_t kMost = 24;  ///< lines through one cell

  /// weight: area represented by the point, relative to the cell's other points.
  struct Point {
    SurfacePoint at;
    float weight = 0;
    std::uint32_t line = 0;  ///< line of its cell, below kMost
  };

  /// surface: flags of the meshes with samples; spacing: sqrt(area / samples), mm.
  CellPoints(const RayScene& rays, std::span<const SurfaceSample> samples, const std::vector<bool>& surface,
             float spacing);

  /// Chooses lines through the cell of a sample, parallel to its geometric normal, at low-discrepancy points
  /// of its tangent plane nearer to it than to any of the neighbours; the index alone, without a seed,
  /// determines their rotation. Returns the cell's number in the batch.
  std::uint32_t add(std::uint32_t index, std::span<const std::uint32_t> neighbours);

  /// Intersects the lines of all cells with the outside of the surface within their cell. Some have no
  /// intersection, if the surface ends or turns away by more than a right angle; others have several.
  void project();

  /// Line by line.
  std::span<const Point> points(std::uint32_t cell) const {
    return std::span(points_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  // A bisector between a sample and a neighbour: a point at d from the sample is the neighbour's if d . away
  // > half2.
  struct Bisector {
    Vec3f away;
    float half2;
  };
  struct Cell {
    Vec3f sample, normal;
    std::uint32_t mesh, triangle;  // surface point of the sample
    std::size_t first_bisector, end_bisector;
  };
  struct Line {
    std::uint32_t cell, number;  // among the cell's
    Ray ray;
  };

  bool is_own_mesh(std::uint32_t mesh) const { return mesh < surface_.size() && surface_[mesh]; }
  bool is_within(const Cell& cell, const Vec3f& from_sample) const;
  void add_crossing(const Line& line, const SurfacePoint& point);
  void sort_by_cell();

  const RayScene& rays_;
  std::span<const SurfaceSample> samples_;
  const std::vector<bool>& surface_;
  float radius_;  // no cell extends farther
  std::vector<Cell> cells_;
  std::vector<Bisector> bisectors_;
  std::vector<Line> lines_;
  std::vector<std::pair<std::uint32_t, Point>> crossings_;  // with their cells, unsorted
  std::vector<Point> points_;
  std::vector<std::size_t> first_;  // into points_, for each cell, and the end
};

}  // namespace opaline
