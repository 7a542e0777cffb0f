// SPDX-License-Identifier: GPL-3.0-or-later
// A line of pixels across the shadow's edge on a translucent floor, by both methods.
#pragma once

#include <cmath>
#include <vector>

#include "opaline/render/direct.h"
#include "opaline/transport/fresnel.h"
#include "support/scenes.h"

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
  std::vector<double> x;                             ///< mm from the lid's edge, one a pixel
  std::vector<double> hierarchical, cached, direct;  ///< exitance, W/mm^2, green; cached: by a surface cache
  std::vector<double> noise;                         ///< estimated standard error of `direct`, W/mm^2
};

/// The line with `entries` random entry points a pixel in the direct picture.
inline EdgeLine shadow_edge_line(const Scene& scene, std::size_t entries) {
  const Prepared prepared(scene);
  const Image sums = prepared.picture();
  Scene interpolated = scene;
  interpolated.settings.evaluator = EvaluatorKind::surface_cache;
  const Image cached = Prepared(interpolated).picture();
  Scene random = scene;
  random.settings.method = Method::direct;
  random.settings.entry_samples = entries;
  DirectState state;
  const Image direct =
      render_direct({random, prepared.world, prepared.rays, prepared.plan}, state).picture.image;
  const DiffuseProfile profile = make_diffuse_profile(scene.media[0]);
  EdgeLine line;
  for (int i = 0; i < sums.width; ++i) {
    const double x = double(channel(sums, i, 0, "P.X")), z = double(channel(sums, i, 0, "P.Z"));
    const double cosine = scene.camera.position.y / std::hypot(x, z, scene.camera.position.y);
    const double exitance = kPi * (1 - profile.average_reflectance) /
                            double(fresnel_transmittance(float(cosine), float(profile.eta)));
    line.x.push_back(x);
    line.hierarchical.push_back(exitance * double(channel(sums, i, 0, "diffuse.G")));
    line.cached.push_back(exitance * double(channel(cached, i, 0, "diffuse.G")));
    line.direct.push_back(exitance * double(channel(direct, i, 0, "diffuse.G")));
    line.noise.push_back(exitance * std::sqrt(double(channel(direct, i, 0, "variance.G"))));
  }
  return line;
}

}  // namespace opaline::test
