// SPDX-License-Identifier: GPL-3.0-or-later
// A picture that shines from all around.
#include <limits>

#include "lights/environment_sample.h"
#include "lights/light_of.h"
#include "opaline/core/error.h"
#include "opaline/lights/environment_picture.h"
#include "opaline/scene/light_reader.h"
#include "opaline/scene/source_place.h"

namespace opaline {
namespace {

struct Turn {
  double degrees = 0, cosine = 1, sine = 0;
};

/// Counterclockwise about +y, seen from above; degrees.
Vec3d turned(const Vec3d& direction, double degrees) {
  thread_local Turn turn;  // rotation of the current light, for millions of directions
  if (degrees != turn.degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    turn = {degrees, std::cos(angle), std::sin(angle)};
  }
  return {direction.x * turn.cosine + direction.z * turn.sine, direction.y,
          direction.z * turn.cosine - direction.x * turn.sine};
}

}  // namespace

Vec3d in_picture(const EnvironmentLight& light, const Vec3f& direction) {
  return turned(Vec3d(direction), -light.rotation);
}

namespace {

/// Radiance of the environment map in a direction. Its channels are separate lights, evaluated one after the other.
RgbF radiance_towards(const EnvironmentLight& light, const Vec3f& direction) {
  struct Asked {
    std::uint64_t picture = 0;
    double rotation = 0;
    Vec3f direction;
    RgbF radiance;
  };
  thread_local Asked last;
  if (last.picture != light.picture->hash() || last.rotation != light.rotation || last.direction != direction)
    last = {light.picture->hash(), light.rotation, direction,
            light.picture->radiance(in_picture(light, direction))};
  return last.radiance;
}

float channel_of(const EnvironmentLight& light, const RgbF& colour) {
  return colour[light.channel.value_or(0)];
}

}  // namespace

void sample_environment(const EnvironmentLight& light, const Vec3f& normal,
                        std::span<const std::array<double, 2>> unit_squares, int samples,
                        std::span<EnvironmentSample> drawn, const Lobe* lobe) {
  std::array<EnvironmentPicture::Sample, kMostAtOnce> of_picture;
  const auto samples_of_picture = std::span(of_picture).first(unit_squares.size());
  const Vec3d turned_normal = in_picture(light, normal);
  if (const EnvironmentPicture::InLobe* const blocks = lobe != nullptr ? known_blocks(light, *lobe) : nullptr)
    light.picture->sample(unit_squares, turned_normal, *blocks, light.rotation, samples_of_picture);
  else
    light.picture->sample(unit_squares, turned_normal, light.rotation, samples_of_picture);
  for (std::size_t i = 0; i < unit_squares.size(); ++i) {
    const Vec3f direction(of_picture[i].direction);
    const RgbF weights = of_picture[i].weight * (1 / float(samples));
    const float assumed = of_picture[i].assumed_cosine;
    drawn[i] = {direction, weights, weights * (assumed > 0 ? assumed : dot(normal, direction)),
                of_picture[i].block};
  }
}

RoomLobe room_lobe(const EnvironmentLight& light, const Vec3f& normal, const Lobe& lobe) {
  return {
      light.picture.get(), light.rotation,
      light.picture->blocks_in_lobe(in_picture(light, lobe.mirrored), lobe.alpha, in_picture(light, normal))};
}

RgbF unshadowed(const EnvironmentLight& light, const Vec3f& normal) {
  return light.picture->unshadowed(in_picture(light, normal));
}

template <>
std::vector<KeyInfo> LightReader<EnvironmentLight>::rows() {
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

template <>
EnvironmentLight LightReader<EnvironmentLight>::read(const ObjectReader& reader, double) {
  EnvironmentLight light;
  const Value file = reader.need("file");
  try {
    light.picture = EnvironmentPicture::read(file.file_path());
  } catch (const Error& failure) {
    throw told_at(file.place(), failure);
  }
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
LightSample LightOf<EnvironmentLight>::sample_channels(const EnvironmentLight& light, const Vec3f&,
                                                       const Vec3f& normal, std::array<double, 2> unit_square,
                                                       int samples, RgbF& weights) {
  EnvironmentSample drawn;
  sample_environment(light, normal, std::span(&unit_square, 1), samples, std::span(&drawn, 1));
  weights = drawn.weights;
  return {drawn.direction, std::numeric_limits<float>::infinity(), channel_of(light, weights)};
}

template <>
LightSample LightOf<EnvironmentLight>::sample(const EnvironmentLight& light, const Vec3f& point,
                                              const Vec3f& normal, std::array<double, 2> unit_square,
                                              int samples) {
  RgbF weights;
  return sample_channels(light, point, normal, unit_square, samples, weights);
}

template <>
float LightOf<EnvironmentLight>::density(const EnvironmentLight& light, const Vec3f&, const Vec3f& normal,
                                         const Vec3f& direction) {
  return light.picture->density(in_picture(light, direction), in_picture(light, normal));
}

template <>
EmitterHit LightOf<EnvironmentLight>::intersect(const EnvironmentLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

template <>
RgbF LightOf<EnvironmentLight>::background(const EnvironmentLight& light, const Vec3f& direction) {
  return RgbF(emission(light)) * channel_of(light, radiance_towards(light, direction));
}

template <>
LightExtent LightOf<EnvironmentLight>::extent(const EnvironmentLight&) {
  return {};
}

template <>
std::optional<Lamp> LightOf<EnvironmentLight>::lamp(const EnvironmentLight&) {
  return {};
}

template <>
std::vector<double> LightOf<EnvironmentLight>::geometry(const EnvironmentLight& light) {
  const std::uint64_t hash = light.picture->hash();
  return {double(hash >> 32), double(hash & 0xffffffff), light.rotation, double(light.channel.value_or(0))};
}

}  // namespace opaline
