// SPDX-License-Identifier: GPL-3.0-or-later
// Samples on a deformed surface: removal where too dense, addition where too sparse.
#pragma once

#include <span>
#include <vector>

#include "sampling/sample_grid.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// Least growth of a triangle's area for gaps between its samples; smaller ones had gaps as wide before.
inline constexpr double kGrown = 1.2 * 1.2;

/// A point of a surface and its geometric normal.
struct Standing {
  Vec3f position, normal;
};

/// True if any two samples of one sheet are closer than this, mm.
bool any_closer(std::span<const Standing> standing, float distance);

class StretchedCloud {
 public:
  /// before, after: the same triangles; radius: minimum distance of samples of one sheet before.
  StretchedCloud(const TriangleList& before, const TriangleList& after, float radius,
                 std::vector<SampleGrid::Place> places);

  /// Removes samples until none of one sheet are closer than this many radii; returns their number.
  std::size_t remove_crowded(float radii);
  /// Adds samples on triangles that grew, at points without samples of their sheet within this many radii;
  /// returns their number.
  std::size_t fill_gaps(float radii);
  /// The current samples.
  SampleGrid grid() const;

 private:
  const TriangleList& before_;
  const TriangleList& after_;
  float radius_;
  std::vector<SampleGrid::Place> places_;
};

}  // namespace opaline
