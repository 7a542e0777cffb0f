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

/// One sample of a light at a point: the contribution to irradiance is weight x cos x Ft x (1 if visible) x
/// emission, with the light's colour (intensity, irradiance or radiance) as emission.
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

/// True if one sample is exact: point and spot lights, and directional ones without an angle.
bool is_delta(const Light& light);

/// Shadow rays from a point to the light, given `light_samples` for a light with an area: 1 for delta lights;
/// a third for a tree of delta lights (ManyLights).
int shadow_rays(const Light& light, int light_samples);

/// True if rays can hit the light: it has an area or is an environment.
bool is_visible(const Light& light);

/// True for the light of a shape: rays hit the shape.
bool is_of_shape(const Light& light);

struct EnvironmentLobe;

/// Specular lobe of a rough boundary towards the camera: GGX facets around the mirror direction.
struct Lobe {
  Vec3f mirrored;                                   ///< unit
  float alpha;                                      ///< > 0
  const EnvironmentLobe* in_environment = nullptr;  ///< specular reflection of an environment, if cached
};

/// Relative density of a lobe at an angle from its axis: that of the facets at the half angle, over its
/// maximum.
float mirrored(const Lobe& lobe, float cosine);

/// Candidate directions per shadow ray for a specular lobe. An environment with many small lights has several
/// candidates, with one chosen for the ray; one if the lobe has a table of the environment.
int lobe_draws(const Light& light, const Lobe& lobe);

/// True for the channels of one image, or of one light tree: their samples have the same directions.
bool share_rays(const Light& a, const Light& b);

/// Seed of a light's random numbers, from its name: independent of other lights.
std::uint64_t light_seed(std::uint64_t seed, const Light& light);

/// The light in a world's space: moved by -origin, with lengths and a point's intensity, W/sr per square of
/// the length, in a unit of so many mm.
Light recentred(const Light& light, const Vec3d& origin, double unit = 1);

/// Samples a light from a point.
/// in    unit_square: in [0, 1)^2, unused by delta lights; samples: number sharing the light's solid angle
///       normal: unit; constant environments are sampled by its cosine, all others by solid angle (sphere) or
///       area (quad)
LightSample sample_light(const Light& light, const Vec3f& point, const Vec3f& normal,
                         std::array<double, 2> unit_square, int samples);

/// Density of sample_light's directions at the point, 1/sr; 0 for delta lights.
/// in    lobe: null, or the lobe to sample for
float sampling_density(const Light& light, const Vec3f& point, const Vec3f& normal, const Vec3f& direction,
                       const Lobe* lobe = nullptr);

/// Hit of a ray with an area light.
struct EmitterHit {
  bool hit = false;
  float t = 0;
  RgbF radiance{};
};
/// Intersects a ray with a light that has an area, before `far`.
EmitterHit intersect_emitter(const Light& light, const Vec3f& origin, const Vec3f& direction, float far);

/// Radiance of the light along a ray without hits.
RgbF background(const Light& light, const Vec3f& direction);

/// Extent of a light. A light with neither centre nor direction is an environment.
struct LightExtent {
  std::optional<Vec3d> center{};   ///< center of a bounding sphere; none: infinitely far
  double radius = 0;               ///< radius of that sphere
  double width = 0;                ///< along its shorter side
  Vec3d along{};                   ///< its middle line, centred at `center`
  std::optional<Vec3d> facing{};   ///< unit; one-sided emission
  std::optional<Vec3d> towards{};  ///< unit; direction to an infinitely far light
};
/// Bounding sphere of the light's shape, world units.
LightExtent extent(const Light& light);

/// All numbers of the light's position and size, excluding its colour; distinct between kinds.
std::vector<double> geometry(const Light& light);

}  // namespace opaline
