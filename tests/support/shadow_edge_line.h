// SPDX-License-Identifier: GPL-3.0-or-later
// A line of pixels across the shadow's edge on a translucent floor, by both methods.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "methods/direct/direct.h"
#include "support/scenes.h"
#include "transport/fresnel.h"

namespace opaline::test {

inline constexpr double kEdgeFreePath = 0.5;  ///< of the floor, mm

/// A floor of 20 x 20 mm under an opaque lid that ends at x = 0, 5 mm above it; the camera looks straight
/// down from below the lid. narrow: a directional light from straight above. wide: a square light, 10 mm wide
/// and 12 mm above the lid, whose penumbra is 5 / 12 x 10 = 4.2 mm wide, 8 mean free paths.
inline Scene shadow_edge_scene(bool wide, ProfileKind profile) {
  Scene scene;
  scene.media = {grey_medium(kEdgeFreePath, .02, 1.3, profile)};
  Shape lid;
  lid.name = "lid";
  lid.source = QuadShape{{-100, 5, -100}, {100, 0, 0}, {0, 0, 200}};
  lid.reflectance = {};  // sends no light back
  scene.shapes = {translucent("floor", QuadShape{{-10, 0, -10}, {0, 0, 20}, {20, 0, 0}}), lid};
  if (wide)
    scene.lights = {{"lamp", QuadLight{{-5, 17, -5}, {10, 0, 0}, {0, 0, 10}, Rgb(1)}}};
  else
    scene.lights = {{"sun", DirectionalLight{{0, -1, 0}, Rgb(1)}}};
  scene.camera.position = {0, 4, 0};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.up = {0, 0, -1};
  scene.camera.field_of_view = 80;
  scene.film.resolution = {32, 32};
  scene.film.crop = {{0, 16, 32, 17}};
  scene.film.half = false;
  return scene;
}

struct EdgeLine {
  std::vector<double> x, z;                  ///< mm from the lid's edge, and along it; one a pixel
  std::vector<double> of_radiance;           ///< exitance over the radiance that is seen
  std::vector<double> hierarchical, cached;  ///< exitance, W/mm^2, green; cached: by a surface cache
};

inline EdgeLine shadow_edge_line(const Scene& scene) {
  const Image sums = Prepared(scene).picture();
  Scene interpolated = scene;
  interpolated.settings.evaluator = EvaluatorKind::surface_cache;
  const Image cached = Prepared(interpolated).picture();
  const DiffuseProfile profile = make_diffuse_profile(scene.media[0]);
  EdgeLine line;
  for (int i = 0; i < sums.width; ++i) {
    const double x = double(channel(sums, i, 0, "P.X")), z = double(channel(sums, i, 0, "P.Z"));
    const double cosine = scene.camera.position.y / std::hypot(x, z, scene.camera.position.y);
    const double exitance = kPi * (1 - profile.average_reflectance) /
                            double(fresnel_transmittance(float(cosine), float(profile.eta)));
    line.x.push_back(x);
    line.z.push_back(z);
    line.of_radiance.push_back(exitance);
    line.hierarchical.push_back(exitance * double(channel(sums, i, 0, "diffuse.G")));
    line.cached.push_back(exitance * double(channel(cached, i, 0, "diffuse.G")));
  }
  return line;
}

struct RandomEdgeLine {
  std::vector<double> exitance;  ///< W/mm^2, green
  std::vector<double> noise;     ///< its estimated standard error, W/mm^2
};

/// By `direct`, with `entries` random entry points a pixel.
inline RandomEdgeLine direct_edge_line(Scene scene, const EdgeLine& line, std::size_t entries) {
  scene.settings.method = Method::direct;
  scene.settings.entry_samples = entries;
  const Prepared prepared(scene);
  DirectState state;
  const Image direct =
      render_direct({scene, prepared.world, prepared.rays, prepared.plan}, state).picture.image;
  RandomEdgeLine found;
  for (int i = 0; i < direct.width; ++i) {
    const double exitance = line.of_radiance[std::size_t(i)];
    found.exitance.push_back(exitance * double(channel(direct, i, 0, "diffuse.G")));
    found.noise.push_back(exitance * std::sqrt(double(channel(direct, i, 0, "variance.G"))));
  }
  return found;
}

}  // namespace opaline::test
