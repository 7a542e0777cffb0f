// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/expected_seconds.h"

#include "subsurface/method.h"

namespace opaline {
namespace {

// CPU seconds, fitted to the output of bench_plan.
constexpr double kTriangle = 7e-7;  // read, mended, in the rays' tree
constexpr double kPixel = 5e-7;     // a camera ray, shaded

double seconds_of_shading(const Scene& scene, const Lighting& lighting) {
  const Film& film = scene.film;
  const double pixels = double(film.resolution[0]) * double(film.resolution[1]);
  return pixels * (double(film.samples_per_pixel) * (kPixel + kSecondsOfShadowRay * lighting.lights) +
                   method_of(scene.settings.method).seconds_of_pixel(scene, lighting));
}

}  // namespace

double expected_seconds(const Scene& scene, const Plan& plan) {
  const Lighting lighting = lighting_of(scene);
  double seconds = kTriangle * double(plan.triangles) + seconds_of_shading(scene, lighting);
  for (const BodyPlan& group : plan.groups)
    seconds += method_of(group.method).seconds(scene, group, lighting);
  return seconds;
}

}  // namespace opaline
