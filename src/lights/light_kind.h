// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of a kind of light. Each kind defines them all in a header of this folder, as overloads for its struct of
// scene.h; all_lights.h includes these headers. A kind that lacks a function does not compile.
//
//   light_keys          rows of the section "light.<type>" without `name` and `visible`, `type` first; none: scene files
//                       cannot contain this kind
//   read_light          reads these keys; error: Error{bad_input} at the value
//   geometry            all numbers that change the light at a point, except the colour; cache keys contain them
//   lamp_of             bounds for a tree of many lights; none: trees cannot contain this kind
//   sample_channels     sample_light with the weight of each channel, for a kind with a member `channel`
//   is_delta, recentred, sample_light, sampling_density, intersect_emitter, background, extent
//                       the functions of light.h for a Light
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "lights/light.h"
#include "values/key_info.h"
#include "values/value.h"

namespace opaline {

/// A light as a tree of many lights bounds it.
struct Lamp {
  Vec3d center{};
  double radius = 0;
  std::optional<Vec3d> facing{};  ///< unit, the way that it shines; none: all around
  /// Off that way, to where its light begins to fade and where it ends, radians.
  double full = std::numbers::pi, reach = std::numbers::pi;
  bool fades_by_square = false;
  double intensity = 0;  ///< the way it is brightest, for an emission of 1
};
std::optional<Lamp> lamp_of(const Light& light);

/// The colour in one channel alone; no channel: in all.
inline Rgb in_channel(const Rgb& colour, std::optional<std::size_t> channel) {
  if (!channel) return colour;
  Rgb alone;
  alone[*channel] = colour[*channel];
  return alone;
}

/// The value in a channel; no channel: of a grey colour.
inline float channel_of(const RgbF& colour, std::optional<std::size_t> channel) {
  return colour[channel.value_or(0)];
}

}  // namespace opaline
