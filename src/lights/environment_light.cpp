// SPDX-License-Identifier: GPL-3.0-or-later
// Environment map as a light.
#include <cmath>
#include <numbers>

#include "lights/environment_sample.h"

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

/// Radiance of the environment map in a direction. Its channels are separate lights, evaluated one after the
/// other.
RgbF radiance_towards(const EnvironmentLight& light, const Vec3f& direction) {
  struct Asked {
    std::uint64_t picture = 0;
    double rotation = 0;
    Vec3f direction;
    RgbF radiance;
  };
  thread_local Asked last;  // channels are separate lights, evaluated one after the other
  if (last.picture != light.picture->hash() || last.rotation != light.rotation || last.direction != direction)
    last = {light.picture->hash(), light.rotation, direction,
            light.picture->radiance(in_picture(light, direction))};
  return last.radiance;
}

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

EnvironmentLobe environment_lobe(const EnvironmentLight& light, const Vec3f& normal, const Lobe& lobe) {
  return {
      light.picture.get(), light.rotation,
      light.picture->blocks_in_lobe(in_picture(light, lobe.mirrored), lobe.alpha, in_picture(light, normal))};
}

RgbF unshadowed(const EnvironmentLight& light, const Vec3f& normal) {
  return light.picture->unshadowed(in_picture(light, normal));
}

}  // namespace opaline
