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
  Vec3f eye;  ///< camera, mm, recentred as the samples are
  InstructionSet instruction_set = InstructionSet::automatic;
};

/// Mean relative error of the exitance over the surface facing the camera, per channel, from approximating
/// the near field as flat. Beside a crease, part of it lies on another face, at other distances and with
/// other irradiance. 0 without creases. Derived in src/exitance/README.md, "Creases".
std::array<float, 3> crease_error(const CreaseErrorInput& input);

/// Near kernel R_d (1 - w) as rings around a point; masses sum to 1 in each channel with a near field.
class NearRings {
 public:
  /// radius: of the near field, units of the world.
  NearRings(const DiffuseProfile& profile, double radius);

  /// Fraction of a plane's near field beyond a straight edge at this distance, per channel.
  std::array<double, 3> beyond_border(double distance) const;

  /// Weight of a perpendicular half plane starting at the foot of the point's perpendicular, of this length:
  /// half of the kernel's mass at larger distances.
  std::array<double, 3> on_wall(double distance) const;

 private:
  static constexpr std::size_t kRings = 48;  // narrower towards the centre, where the kernel is steep
  std::array<double, kRings> distances_{};   // mm
  std::array<std::array<double, 3>, kRings> masses_{};
};

}  // namespace opaline
