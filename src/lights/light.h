// SPDX-License-Identifier: GPL-3.0-or-later
// Lights of any kind: positions, sampling, and radiance at a point.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "opaline/scene.h"
#include "opaline/vec3.h"

namespace opaline {

/// One sample of a light seen from a point: the contribution to irradiance is weight x cos x Ft x (1
/// if not occluded) x emission, emission being the light's colour (intensity, irradiance or radiance).
struct LightSample {
  Vec3f direction;  ///< unit, from the point towards the light
  float distance;   ///< infinity for directional lights and surroundings
  float weight =
      0;  ///< intensity -> 1/d^2, irradiance -> 1, radiance -> solid angle / samples; 0: no light here
};

/// Colour of the light, a factor of a sample's weight.
Rgb emission(const Light& light);

/// The light in another colour.
Light with_emission(const Light& light, const Rgb& emission);

/// True where one sample is exact: point and spot lights, and directional ones without an angle.
bool is_delta(const Light& light);

/// Shadow rays from a point to the light where `light_samples` go to one with an area: 1 to delta lights; to a tree of
/// delta lights (ManyLights) a third.
int shadow_rays(const Light& light, int light_samples);

/// True if the light has an area or is all around: rays see it.
bool is_visible(const Light& light);

struct RoomLobe;

/// Where a surface mirrors a light towards the eye: facets (GGX) about the direction of a smooth mirror.
struct Lobe {
  Vec3f mirrored;                     ///< unit
  float alpha;                        ///< > 0
  const RoomLobe* in_room = nullptr;  ///< specular reflection of an environment, if cached
};

/// Relative density of a lobe at an angle from its axis: that of the facets at the half angle, over its maximum.
float mirrored(const Lobe& lobe, float cosine);

/// Directions drawn for each shadow ray that is to show what a lobe mirrors: of a room, whose lamps are many and
/// small, some, of which the ray takes one. Where what the lobe mirrors of the room is known they are alike, and count as one.
int lobe_draws(const Light& light, const Lobe& lobe);

/// True for the channels of one picture, or of one tree of lights: their samples have the same directions.
bool share_rays(const Light& a, const Light& b);

/// Seed of a light's random numbers: by its name, so adding or removing another light leaves them alone.
std::uint64_t light_seed(std::uint64_t seed, const Light& light);

/// The light in a world's space: moved by -origin, its lengths and a point's intensity, W/sr per square of
/// the length, in a unit of so many mm.
Light recentred(const Light& light, const Vec3d& origin, double unit = 1);

/// Sample of a light from a point.
/// in    unit_square: in [0, 1)^2, unused by delta lights; samples: how many share the light's solid angle
///       normal: unit; surroundings are sampled by its cosine, all others by solid angle (sphere) or area
///       (quad)
LightSample sample_light(const Light& light, const Vec3f& point, const Vec3f& normal,
                         std::array<double, 2> unit_square, int samples);

/// With which sample_light draws a direction from the point, 1/sr; 0 for delta lights.
/// in    lobe: if not null, for which directions are drawn
float sampling_density(const Light& light, const Vec3f& point, const Vec3f& normal, const Vec3f& direction,
                       const Lobe* lobe = nullptr);

/// Radiance of area lights that a ray meets before `far` (nearest one), and whether there is any.
struct EmitterHit {
  bool hit = false;
  float t = 0;
  RgbF radiance{};
};
/// Where a ray meets a light that has an area, nearer than `far`.
EmitterHit intersect_emitter(const Light& light, const Vec3f& origin, const Vec3f& direction, float far);

/// Radiance that a ray sees of the light if it meets nothing.
RgbF background(const Light& light, const Vec3f& direction);

/// Where a light is. A light with neither centre nor direction is all around.
struct LightExtent {
  std::optional<Vec3d> center{};   ///< center of a ball around it; none: infinitely far
  double radius = 0;               ///< radius of that ball
  double width = 0;                ///< along its shorter side
  Vec3d along{};                   ///< from end to end of its middle line, which `center` is the middle of
  std::optional<Vec3d> facing{};   ///< unit; it shines on this side only
  std::optional<Vec3d> towards{};  ///< unit; an infinitely far light lies that way
};
/// A ball around the light's shape, world units.
LightExtent extent(const Light& light);

/// All numbers that say where the light is and how large, none of its colour; of another kind, others.
std::vector<double> geometry(const Light& light);

}  // namespace opaline
