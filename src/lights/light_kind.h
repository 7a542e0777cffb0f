// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of a kind of light, all defined in one header of this folder, as overloads for its struct in
// scene.h; all_lights.h includes these headers. A kind without one of them does not compile.
//
//     light_keys          rows of the section "light.<type>" without `name` and `visible`, `type` first;
//                         none: scene files cannot contain this kind
//     read_light          reads these keys; error: Error{bad_input} at the value
//     geometry            all numbers affecting the light at a point, except the colour; part of cache keys
//     lamp_of             bounds for a tree of many lights; none: trees cannot contain this kind
//     sample_channels     sample_light with the weight of each channel, for a kind with a member `channel`
//     is_delta, recentred, sample_light, sampling_density, intersect_emitter, background, extent
//                         the functions of light.h for a Light
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "lights/light.h"
#include "values/key_info.h"
#include "values/value.h"

namespace opaline {

/// Bounds of a light in a light tree.
struct Lamp {
  Vec3d center{};
  double radius = 0;
  std::optional<Vec3d> facing{};  ///< unit axis of its emission; none: omnidirectional
  /// Angles from the axis to the beginning and the end of the falloff, radians.
  double full = std::numbers::pi, reach = std::numbers::pi;
  bool fades_by_square = false;
  double intensity = 0;  ///< maximum over directions, at unit emission
};
std::optional<Lamp> lamp_of(const Light& light);

/// A colour in one channel alone; no channel: in all.
inline Rgb in_channel(const Rgb& colour, std::optional<std::size_t> channel) {
  if (!channel) return colour;
  Rgb alone;
  alone[*channel] = colour[*channel];
  return alone;
}

/// Value in a channel; no channel: of a grey colour.
inline float channel_of(const RgbF& colour, std::optional<std::size_t> channel) {
  return colour[channel.value_or(0)];
}

}  // namespace opaline
