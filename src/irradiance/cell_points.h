// SPDX-License-Identifier: GPL-3.0-or-later
// Several points of the surface for one sample: spread evenly over its Voronoi cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "opaline/geometry/world.h"
#include "opaline/sampling/sample_surface.h"

namespace opaline {

/// Whether a mesh of the world has samples, by its index; meshes beyond the end have none.
std::vector<bool> meshes_of(std::span<const SurfaceSample> samples);

/// Points of the cells of a batch of samples, found together: add the samples, project, read the points.
class CellPoints {
 public:
  static constexpr std::uint32_t kMost = 24;  ///< points of one cell
  struct Range {
    std::uint32_t first = 0, count = 0;  ///< of point()
  };

  /// surface: whether a mesh of the world has samples; spacing: sqrt(area / samples), mm.
  CellPoints(const RayScene& rays, std::span<const SurfaceSample> samples, const std::vector<bool>& surface,
             float spacing);

  /// Chooses points around a sample that are nearer to it than to any of the neighbours, low-discrepancy ones
  /// in its tangent plane; the index, and no seed, chooses their rotation.
  Range add(std::uint32_t index, std::span<const std::uint32_t> neighbours);

  /// Brings all points to the surface along their samples' geometric normals. Some find none: the surface
  /// ends there, turns away by more than a right angle, or is farther off the tangent plane than the point
  /// from its sample.
  void project();

  /// Null where the surface was not found.
  const SurfacePoint* point(std::uint32_t i) const { return found_[i] ? &points_[i] : nullptr; }

 private:
  bool is_own_mesh(std::uint32_t mesh) const { return mesh < surface_.size() && surface_[mesh]; }
  void look_behind_other_meshes();

  const RayScene& rays_;
  std::span<const SurfaceSample> samples_;
  const std::vector<bool>& surface_;
  float radius_;  // no cell reaches farther
  std::vector<TracedRay> traced_;
  std::vector<float> lengths_;  // of the rays before they were traced
  std::vector<SurfacePoint> points_;
  std::vector<bool> found_;
};

}  // namespace opaline
