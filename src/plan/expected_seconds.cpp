// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/expected_seconds.h"

#include <algorithm>
#include <cmath>

#include "scene/scene_properties.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

// CPU seconds, fitted to the output of bench_plan.
constexpr double kTriangle = 7e-7;  // read, mended, in the rays' tree
constexpr double kPixel = 5e-7;     // a camera ray, shaded
constexpr double kExtended = 1e-6;  // the light of an extended light at a hit, diffuse and mirrored

double seconds_of_hit(const Lighting& lighting) {
  return kPixel + kSecondsOfShadowRay * lighting.lights + kExtended * lighting.extended_lights;
}

// At places of the image and at samples.
double seconds_of_bounces(const Scene& scene, const Plan& plan, const Lighting& lighting) {
  constexpr double kAcross = 64, kHits = .5;  // as BouncedPlaces; share of the rays with a hit
  if (bounces_of(scene) == 0) return 0;
  const double width = double(scene.film.resolution[0]), height = double(scene.film.resolution[1]);
  const double pixels = std::pow(std::max(1., std::max(width, height) / kAcross), 2);  // per place
  double rays = width * height / pixels * std::clamp(3 * pixels, 48., 192.) * kHits;
  for (const BodyPlan& group : plan.groups)
    if (const SubsurfaceMethod& method = method_of(group.method); method.needs_samples())
      rays += double(group.samples) * method.gathered_rays();
  return rays * seconds_of_hit(lighting);
}

double seconds_of_shading(const Scene& scene, const Lighting& lighting) {
  const Film& film = scene.film;
  const double pixels = double(film.resolution[0]) * double(film.resolution[1]);
  return pixels * (double(film.samples_per_pixel) * seconds_of_hit(lighting) +
                   method_of(scene.settings.method).seconds_of_pixel(scene, lighting));
}

}  // namespace

double expected_seconds(const Scene& scene, const Plan& plan) {
  const Lighting lighting = lighting_of(scene);
  double seconds = seconds_of_shading(scene, lighting) + seconds_of_bounces(scene, plan, lighting);
  for (const BodyPlan& group : plan.groups)
    seconds += method_of(group.method).seconds(scene, group, lighting);
  return kTriangle * double(plan.triangles) + seconds * double(1 + scene.other_wavelengths.size());
}

}  // namespace opaline
