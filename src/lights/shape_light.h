// SPDX-License-Identifier: GPL-3.0-or-later
// Light emitted by the surface of a shape.
#pragma once

#include <algorithm>
#include <limits>

#include "lights/emitting_surface.h"
#include "lights/light_kind.h"
#include "lights/sphere_light.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const ShapeLight&) {
  return {};  // shape.emission
}

inline void read_light(const ObjectReader&, double, ShapeLight&) {}

inline bool is_delta(const ShapeLight&) {
  return false;
}

inline ShapeLight recentred(ShapeLight light, const Vec3d&, double) {
  return light;  // by light_in_world
}

/// Its bounding sphere, if directions to it are sampled in the sphere's cone: from outside of a shape that fills it well.
inline std::optional<SphereLight> sampled_ball(const ShapeLight& light, const Vec3f& point) {
  const EmittingSurface& surface = *light.surface;
  const Vec3d to = surface.center() - Vec3d(point);
  if (!surface.is_round() || dot(to, to) <= surface.radius() * surface.radius()) return {};
  return SphereLight{surface.center(), surface.radius(), {}};
}

/// Shadow rays end before the surface: it would block those at grazing angles.
/// distance: to the surface; cosine: with its normal there
inline float cleared(const EmittingSurface& surface, double distance, double cosine) {
  constexpr double kMostCleared = .5;  // part of the distance
  return float(distance - std::min(double(surface.clearance()) / cosine, kMostCleared * distance));
}

inline LightSample sample_channels(const ShapeLight& light, const Vec3f& point, const Vec3f& normal,
                                   std::array<double, 2> unit_square, int samples, RgbF& weights) {
  weights = RgbF(0);
  if (light.surface == nullptr) return {};
  if (const std::optional<SphereLight> ball = sampled_ball(light, point)) {
    LightSample sample = sample_light(*ball, point, normal, unit_square, samples);
    float distance = std::numeric_limits<float>::infinity();
    const auto met = light.surface->first_met(point, sample.direction, light.surface->clearance(), distance);
    if (!met) return {sample.direction, sample.distance};
    sample.distance = cleared(*light.surface, double(distance), -double(dot(met->normal, sample.direction)));
    weights = RgbF(sample.weight);
    return sample;
  }
  const EmittingSurface::Point emitter = light.surface->sample(unit_square);
  const Vec3d to(emitter.position - point);
  const double d2 = dot(to, to), distance = std::sqrt(d2), facing = -dot(to, Vec3d(emitter.normal));
  if (!(d2 > 0)) return {};
  LightSample sample{Vec3f(to / distance), float(distance)};
  if (!(facing > 0)) return sample;
  const double cosine = facing / distance;
  sample.distance = cleared(*light.surface, distance, cosine);
  weights = light.surface->texel(emitter) * float(cosine / (d2 * emitter.density * samples));
  sample.weight = channel_of(weights, light.channel);
  return sample;
}

inline LightSample sample_light(const ShapeLight& light, const Vec3f& point, const Vec3f& normal,
                                std::array<double, 2> unit_square, int samples) {
  RgbF weights;
  return sample_channels(light, point, normal, unit_square, samples, weights);
}

inline float sampling_density(const ShapeLight& light, const Vec3f& point, const Vec3f& normal,
                              const Vec3f& direction) {
  if (light.surface == nullptr) return 0;
  float distance = std::numeric_limits<float>::infinity();
  const auto met = light.surface->first_met(point, direction, light.surface->clearance(), distance);
  if (!met) return 0;
  if (const std::optional<SphereLight> ball = sampled_ball(light, point))
    return sampling_density(*ball, point, normal, direction);
  const double cosine = -double(dot(met->normal, direction));
  return float(met->density * double(distance) * double(distance) / cosine);
}

// The ray may end on this surface.
inline EmitterHit intersect_emitter(const ShapeLight& light, const Vec3f& origin, const Vec3f& direction,
                                    float far) {
  constexpr float kBeyond = 1.0001f;
  if (light.surface == nullptr) return {};
  float distance = far * kBeyond;
  const auto met = light.surface->first_met(origin, direction, 0, distance);
  if (!met) return {};
  return {true, distance, RgbF(in_channel(light.radiance, light.channel)) * light.surface->texel(*met)};
}

inline RgbF background(const ShapeLight&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const ShapeLight& light) {
  if (light.surface == nullptr) return {.center = Vec3d{}};
  const Bounds& box = light.surface->box();
  const double radius = .5 * length(box.high - box.low);
  return {.center = .5 * (box.low + box.high), .radius = radius, .width = 2 * radius};
}

// Without a texture: trees have no texels.
inline std::optional<Lamp> lamp_of(const ShapeLight& light) {
  if (light.channel) return {};
  if (light.surface == nullptr) return Lamp{};
  const EmittingSurface& surface = *light.surface;
  return Lamp{.center = surface.center(), .radius = surface.radius(), .intensity = .25 * surface.area()};
}

inline std::vector<double> geometry(const ShapeLight& light) {
  const std::uint64_t hash = light.surface != nullptr ? light.surface->hash() : 0;
  return {double(hash >> 32), double(hash & 0xffffffff), double(light.channel.value_or(0))};
}

}  // namespace opaline
