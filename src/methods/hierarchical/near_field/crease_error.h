// SPDX-License-Identifier: GPL-3.0-or-later
// Error of the near field at creases of the surface.
#pragma once

#include <array>

#include "exitance/evaluate.h"

namespace opaline {

struct CreaseErrorInput {
  const Octree& octree;
  const SplitKernel& kernel;
  const DiffuseProfile& profile;
  Vec3f eye;  ///< mm, recentred as the samples are
  InstructionSet instruction_set = InstructionSet::automatic;
};

/// Mean relative error of the exitance over what of the surface faces the eye, per channel, because the near
/// field is taken for flat: beside a crease part of it lies on another face, at other distances and in other
/// light. Derived in src/exitance/README.md, "Creases"; 0 on a surface without creases.
std::array<float, 3> crease_error(const CreaseErrorInput& input);

/// The near kernel R_d (1 - w) as rings around a point; masses sum to 1 in each channel that has a near
/// field.
class NearRings {
 public:
  /// radius: of the near field, units of the world.
  NearRings(const DiffuseProfile& profile, double radius);

  /// The fraction of a plane's near field lying beyond a straight border at this distance, per channel.
  std::array<double, 3> beyond_border(double distance) const;

  /// The share that a half plane at right angles gives, from its edge on the foot of the point's
  /// perpendicular, which is this long: half of what is farther away than that.
  std::array<double, 3> on_wall(double distance) const;

 private:
  static constexpr std::size_t kRings = 48;  // narrower towards the middle, where the kernel is steep
  std::array<double, kRings> distances_{};   // mm
  std::array<std::array<double, 3>, kRings> masses_{};
};

}  // namespace opaline
