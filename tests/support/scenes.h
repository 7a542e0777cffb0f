// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that several tests build on.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "opaline/scene.h"
#include "render/render.h"
#include "session/session_records.h"

namespace opaline::test {

inline constexpr double kPi = 3.14159265358979323846;

/// A medium given by mean free path (mm) and 1 - reduced albedo, the same in all channels; of normalized diffusion the fit of
/// the steepest profile.
inline Medium grey_medium(double mean_free_path, double absorbed, double eta,
                          ProfileKind profile = ProfileKind::dipole) {
  const double sigma_t_prime = 1 / mean_free_path;
  Medium medium{"grey", PhysicalMedium{Rgb(absorbed * sigma_t_prime), Rgb((1 - absorbed) * sigma_t_prime)},
                eta, profile};
  medium.fit = NormalizedDiffusionFit::diffuse_entry;
  return medium;
}

inline Medium marble() {
  return {"marble", PhysicalMedium{{.0021, .0041, .0071}, {2.19, 2.62, 3.00}}, 1.5, ProfileKind::dipole};
}

inline Shape translucent(const std::string& name, ShapeSource source, std::size_t medium = 0) {
  Shape shape;
  shape.name = name;
  shape.source = std::move(source);
  shape.medium = medium;
  return shape;
}

/// One translucent shape in one medium, seen from +z, no light.
inline Scene single_shape(ShapeSource source, const Medium& medium, std::size_t samples) {
  Scene scene;
  scene.media = {medium};
  scene.shapes = {translucent("shape", std::move(source))};
  scene.camera.position = {0, 0, 100};
  scene.camera.field_of_view = 40;
  scene.film.resolution = {32, 32};
  scene.film.half = false;
  scene.settings.samples = samples;
  return scene;
}

inline Light point_light(const Vec3d& position, const Rgb& intensity) {
  return {"point", PointLight{position, intensity}};
}

/// A scene and what is prepared of it.
struct Prepared {
  Session session;
  const Scene& scene;
  const World& world;
  const RayScene& rays;
  const Plan& plan;
  std::span<const Body> bodies;

  explicit Prepared(Scene s)
      : scene((session.edit(std::move(s)), session.prepare(), session.scene())),
        world(session.world()),
        rays(session.rays()),
        plan(session.plan()),
        bodies(session.bodies()) {}

  Image picture() const { return render({scene, world, rays, bodies}).image; }
};

/// The group's samples with irradiance set by hand, as a tree.
inline Octree tree_with_irradiance(const SurfaceSamples& surface, const RgbF& irradiance) {
  std::vector<FluxSample> flux;
  for (const SurfaceSample& s : surface.samples) flux.push_back({s.position, s.area, irradiance, s.normal});
  return build_octree(flux);
}

/// Value of a named channel at a pixel.
inline float channel(const Image& image, int x, int y, const std::string& name) {
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    if (image.channels[c] == name)
      return image
          .pixels[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * image.channels.size() + c];
  throw std::runtime_error("no channel " + name);
}

}  // namespace opaline::test
