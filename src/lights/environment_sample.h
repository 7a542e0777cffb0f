// SPDX-License-Identifier: GPL-3.0-or-later
// Sample of an environment before its shadow ray.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "lights/environment_picture.h"
#include "lights/light.h"

namespace opaline {

/// Directions drawn for each shadow ray that is to show what a lobe mirrors.
inline constexpr int kLobeDraws = 4;

inline constexpr std::size_t kMostAtOnce = 8;

/// Specular reflection of an environment by a lobe.
struct RoomLobe {
  const EnvironmentPicture* picture;
  double rotation;
  EnvironmentPicture::InLobe blocks;
};
RoomLobe room_lobe(const EnvironmentLight& light, const Vec3f& normal, const Lobe& lobe);
/// Null: not known for this light.
inline const EnvironmentPicture::InLobe* known_blocks(const EnvironmentLight& light, const Lobe& lobe) {
  const RoomLobe* const known = lobe.in_room;
  const bool is_this =
      known != nullptr && known->picture == light.picture.get() && known->rotation == light.rotation;
  return is_this ? &known->blocks : nullptr;
}

/// A sample of all channels, as sample_light gives it for each.
struct EnvironmentSample {
  Vec3f direction;
  RgbF weights;
  RgbF unshadowed;          ///< about the irradiance that it brings were nothing in the way
  std::uint32_t block = 0;  ///< block of the environment map
};

/// in    unit_squares: one a sample, at most kMostAtOnce
///       lobe: if not null, for which they are drawn; what is known of it is used
void sample_environment(const EnvironmentLight& light, const Vec3f& normal,
                        std::span<const std::array<double, 2>> unit_squares, int samples,
                        std::span<EnvironmentSample> drawn, const Lobe* lobe = nullptr);

/// A direction as the light's picture has it.
Vec3d in_picture(const EnvironmentLight& light, const Vec3f& direction);

/// Radiance of the light's picture in a direction.
RgbF radiance_towards(const EnvironmentLight& light, const Vec3f& direction);

/// The mean of the sum over samples of what they have as `unshadowed`.
RgbF unshadowed(const EnvironmentLight& light, const Vec3f& normal);

}  // namespace opaline
