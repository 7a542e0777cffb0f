// SPDX-License-Identifier: GPL-3.0-or-later
// A picture that shines from all around.
#include <limits>

#include "lights/light_of.h"
#include "opaline/lights/environment_picture.h"
#include "opaline/scene/light_reader.h"

namespace opaline {
namespace {

/// Counterclockwise about +y, seen from above; degrees.
Vec3d turned(const Vec3d& direction, double degrees) {
  const double angle = degrees * std::numbers::pi / 180, cosine = std::cos(angle), sine = std::sin(angle);
  return {direction.x * cosine + direction.z * sine, direction.y, direction.z * cosine - direction.x * sine};
}

float channel_of(const EnvironmentLight& light, const RgbF& colour) {
  return colour[light.channel.value_or(0)];
}

}  // namespace

template <>
std::vector<KeyInfo> LightReader<EnvironmentLight>::rows() {
  using enum ValueType;
  return {
      {.key = "type", .type = choice, .meaning = "`\"environment\"`: a picture of the room, all around"},
      {.key = "file",
       .type = file,
       .meaning =
           "a lat-long EXR or HDR picture, twice as wide as high, +y up, +z in its middle; relative to the "
           "scene file"},
      {.key = "strength",
       .type = color,
       .range = kNonNegative,
       .default_value = "1",
       .meaning = "times the picture, whose values are then radiance, W/(mm² sr)"},
      {.key = "rotation",
       .type = number,
       .unit = "degrees",
       .range = {-360, 360},
       .default_value = "0",
       .meaning = "about +y, counterclockwise seen from above"}};
}

template <>
EnvironmentLight LightReader<EnvironmentLight>::read(const ObjectReader& reader, double) {
  EnvironmentLight light;
  light.picture = EnvironmentPicture::read(reader.need("file").file_path());
  if (const auto strength = reader.find("strength")) light.strength = strength->color();
  if (const auto rotation = reader.find("rotation")) light.rotation = rotation->number();
  return light;
}

template <>
Rgb LightOf<EnvironmentLight>::emission(const EnvironmentLight& light) {
  if (!light.channel) return light.strength;
  Rgb alone;
  alone[*light.channel] = light.strength[*light.channel];
  return alone;
}

template <>
bool LightOf<EnvironmentLight>::is_delta(const EnvironmentLight&) {
  return false;
}

template <>
EnvironmentLight LightOf<EnvironmentLight>::recentred(EnvironmentLight light, const Vec3d&, double) {
  return light;
}

template <>
LightSample LightOf<EnvironmentLight>::sample(const EnvironmentLight& light, const Vec3f&, const Vec3f&,
                                              std::array<double, 2> unit_square, int samples) {
  const EnvironmentPicture::Sample drawn = light.picture->sample(unit_square);
  return {Vec3f(turned(drawn.direction, light.rotation)), std::numeric_limits<float>::infinity(),
          channel_of(light, drawn.weight) / float(samples)};
}

template <>
float LightOf<EnvironmentLight>::density(const EnvironmentLight& light, const Vec3f&, const Vec3f&,
                                         const Vec3f& direction) {
  return light.picture->density(turned(Vec3d(direction), -light.rotation));
}

template <>
EmitterHit LightOf<EnvironmentLight>::intersect(const EnvironmentLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

template <>
RgbF LightOf<EnvironmentLight>::background(const EnvironmentLight& light, const Vec3f& direction) {
  return RgbF(emission(light)) *
         channel_of(light, light.picture->radiance(turned(Vec3d(direction), -light.rotation)));
}

template <>
LightExtent LightOf<EnvironmentLight>::extent(const EnvironmentLight&) {
  return {};
}

template <>
std::vector<double> LightOf<EnvironmentLight>::geometry(const EnvironmentLight& light) {
  const std::uint64_t hash = light.picture->hash();
  return {double(hash >> 32), double(hash & 0xffffffff), light.rotation, double(light.channel.value_or(0))};
}

}  // namespace opaline
