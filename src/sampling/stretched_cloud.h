// SPDX-License-Identifier: GPL-3.0-or-later
// Samples on a surface that changed its shape: too many in one place, too few in another.
#pragma once

#include <span>
#include <vector>

#include "sampling/sample_grid.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// A triangle whose area is more than this factor of what it was may hold gaps; a gap between samples that
/// was as wide before is no matter of stretch.
inline constexpr double kGrown = 1.2 * 1.2;

/// A place on a surface and the geometric normal there.
struct Standing {
  Vec3f position, normal;
};

/// True if any two of one sheet are closer than this, mm.
bool any_closer(std::span<const Standing> standing, float distance);

class StretchedCloud {
 public:
  /// before, after: the same triangles; radius: no two samples of one sheet were closer before.
  StretchedCloud(const TriangleList& before, const TriangleList& after, float radius,
                 std::vector<SampleGrid::Place> places);

  /// Removes samples until none of one sheet are closer than this many radii; how many.
  std::size_t remove_crowded(float radii);
  /// Adds samples where, on a triangle that grew, nothing of its sheet is within this many radii; how many.
  std::size_t fill_gaps(float radii);
  /// The samples as they are now.
  SampleGrid grid() const;

 private:
  const TriangleList& before_;
  const TriangleList& after_;
  float radius_;
  std::vector<SampleGrid::Place> places_;
};

}  // namespace opaline
