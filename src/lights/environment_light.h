// SPDX-License-Identifier: GPL-3.0-or-later
// An environment map: radiance by direction.
#pragma once

#include <limits>

#include "lights/environment_sample.h"
#include "lights/light_kind.h"
#include "opaline/error.h"
#include "scene/source_place.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const EnvironmentLight&) {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"environment\"`: an environment map"},
          {.key = "file",
           .type = file,
           .meaning = "lat-long EXR, HDR or PNG image, twice as wide as high, +y up, +z at the centre; "
                      "relative to the scene file"},
          {.key = "strength",
           .type = color,
           .range = kNonNegative,
           .default_value = "1",
           .meaning = "factor of the image; the product is radiance, W/(mm² sr)"},
          {.key = "rotation",
           .type = number,
           .unit = "degrees",
           .range = {-360, 360},
           .default_value = "0",
           .meaning = "rotation about +y, counter-clockwise seen from above"}};
}

inline void read_light(const ObjectReader& reader, double, EnvironmentLight& light) {
  const Value file = reader.need("file");
  try {
    const ThreeWavelengths* const wavelengths = file.wavelengths();
    light.picture =
        EnvironmentPicture::read(file.file_path(), wavelengths != nullptr ? &wavelengths->from_rgb : nullptr);
  } catch (const Error& failure) {
    throw told_at(file.place(), failure);
  }
  if (const auto strength = reader.find("strength")) light.strength = strength->color();
  if (const auto rotation = reader.find("rotation")) light.rotation = rotation->number();
}

inline bool is_delta(const EnvironmentLight&) {
  return false;
}

inline EnvironmentLight recentred(EnvironmentLight light, const Vec3d&, double) {
  return light;
}

inline LightSample sample_channels(const EnvironmentLight& light, const Vec3f&, const Vec3f& normal,
                                   std::array<double, 2> unit_square, int samples, RgbF& weights) {
  EnvironmentSample drawn;
  sample_environment(light, normal, std::span(&unit_square, 1), samples, std::span(&drawn, 1));
  weights = drawn.weights;
  return {drawn.direction, std::numeric_limits<float>::infinity(), channel_of(weights, light.channel)};
}

inline LightSample sample_light(const EnvironmentLight& light, const Vec3f& point, const Vec3f& normal,
                                std::array<double, 2> unit_square, int samples) {
  RgbF weights;
  return sample_channels(light, point, normal, unit_square, samples, weights);
}

inline float sampling_density(const EnvironmentLight& light, const Vec3f&, const Vec3f& normal,
                              const Vec3f& direction) {
  return light.picture->density(in_picture(light, direction), in_picture(light, normal));
}

inline EmitterHit intersect_emitter(const EnvironmentLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

inline RgbF background(const EnvironmentLight& light, const Vec3f& direction) {
  return RgbF(in_channel(light.strength, light.channel)) *
         channel_of(radiance_towards(light, direction), light.channel);
}

inline LightExtent extent(const EnvironmentLight&) {
  return {};
}

inline std::optional<Lamp> lamp_of(const EnvironmentLight&) {
  return {};
}

inline std::vector<double> geometry(const EnvironmentLight& light) {
  const std::uint64_t hash = light.picture->hash();
  return {double(hash >> 32), double(hash & 0xffffffff), light.rotation, double(light.channel.value_or(0))};
}

}  // namespace opaline
