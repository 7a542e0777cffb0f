// SPDX-License-Identifier: GPL-3.0-or-later
// Operations of a kind of light. Each kind has a file that defines all of it, and how the scene file gives it
// (scene/light_reader.h); a kind without one of these does not link.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "opaline/lights/light.h"

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

template <class Kind>
struct LightOf {
  static Rgb emission(const Kind& light);
  static bool is_delta(const Kind& light);
  /// The light in a world's space, as recentred says.
  static Kind recentred(Kind light, const Vec3d& origin, double unit);
  static LightSample sample(const Kind& light, const Vec3f& point, const Vec3f& normal,
                            std::array<double, 2> unit_square, int samples);
  /// Samples a kind with one light per channel: the weight of each channel.
  static LightSample sample_channels(const Kind& light, const Vec3f& point, const Vec3f& normal,
                                     std::array<double, 2> unit_square, int samples, RgbF& weights);
  /// Density of directions from the point that `sample` draws, 1/sr; 0 for delta lights.
  static float density(const Kind& light, const Vec3f& point, const Vec3f& normal, const Vec3f& direction);
  /// Where a ray meets the light itself before `far`; no hit for lights without an area.
  static EmitterHit intersect(const Kind& light, const Vec3f& origin, const Vec3f& direction, float far);
  /// Radiance along a ray that hits nothing; 0 for lights at finite distance.
  static RgbF background(const Kind& light, const Vec3f& direction);
  static LightExtent extent(const Kind& light);
  /// None: trees cannot hold it.
  static std::optional<Lamp> lamp(const Kind& light);
  /// All numbers but the colour's that change what a point receives: place, size, direction, cone. Keys of
  /// kept results are made of them, so one that is missing keeps a result that is no longer right.
  static std::vector<double> geometry(const Kind& light);
};

/// Lamp of a light of any kind: light.cpp.
std::optional<Lamp> lamp_of(const Light& light);

}  // namespace opaline
