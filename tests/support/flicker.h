// SPDX-License-Identifier: GPL-3.0-or-later
// Slow shots in which a pixel shows one place of the surface for good, and how far their shading flickers.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "session/session_records.h"
#include "support/scenes.h"

namespace opaline::test {

/// Writes the mesh in OBJ, each vertex moved along its line of sight by a wave that runs upwards: the surface
/// bends, stretches and turns to the light, and the camera at `eye` sees every place of it where it was.
/// in    eye, wave_length: mm, in the space of the mesh; share: of the distance to the eye; phase: radians
inline void write_rippled(const Mesh& mesh, const Vec3d& eye, double wave_length, double share, double phase,
                          const std::string& path) {
  std::ofstream file(path);
  file.precision(17);
  for (const Vec3d& p : mesh.positions) {
    const Vec3d q = eye + (p - eye) * (1 + share * std::sin(2 * kPi * p.y / wave_length - phase));
    file << "v " << q.x << ' ' << q.y << ' ' << q.z << '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) file << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
}

/// Frames in which the first shape ripples by 1 % of its distance, there and back in `period` frames; one
/// mesh file each in `folder`.
inline std::vector<Scene> rippling(const Scene& scene, double wave_length, int period, int frames,
                                   const std::string& folder) {
  const World world = make_world(scene);
  std::vector<Scene> shot;
  for (int f = 0; f < frames; ++f) {
    const std::string path = folder + "/rippled." + std::to_string(f) + ".obj";
    write_rippled(world.meshes.at(0), scene.camera.position - world.origin, wave_length, .01,
                  2 * kPi * f / period, path);
    shot.push_back(scene);
    shot.back().shapes[0].source = MeshFile{path, false, {}};
    shot.back().shapes[0].to_world.translation = world.origin;
  }
  return shot;
}

/// Frames in which the first light, a point, goes around the y axis by some degrees each.
inline std::vector<Scene> sweeping(const Scene& scene, double degrees, int frames) {
  std::vector<Scene> shot(std::size_t(frames), scene);
  for (int f = 0; f < frames; ++f) {
    auto* light = std::get_if<PointLight>(&shot[std::size_t(f)].lights.at(0).source);
    if (light == nullptr) throw std::runtime_error("the scene's first light is no point");
    const double angle = kPi / 180 * degrees * f;
    const Vec3d p = light->position;
    light->position = {std::cos(angle) * p.x + std::sin(angle) * p.z, p.y,
                       std::cos(angle) * p.z - std::sin(angle) * p.x};
  }
  return shot;
}

/// Diffuse radiance R G B of each pixel and, as A, its coverage.
inline Image diffuse_layer(const Image& image) {
  Image layer;
  layer.width = layer.full_width = image.width;
  layer.height = layer.full_height = image.height;
  layer.channels = {"R", "G", "B", "A"};
  for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B", "A"})
    if (std::ranges::find(image.channels, name) == image.channels.end()) throw std::runtime_error(name);
  layer.pixels.resize(4 * std::size_t(image.width) * std::size_t(image.height));
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B", "A"})
        layer.pixels[i++] = channel(image, x, y, name);
  return layer;
}

/// By one session: its samples go along from frame to frame.
inline std::vector<Image> carried_pictures(const std::vector<Scene>& shot) {
  Session session;
  std::vector<Image> pictures;
  for (const Scene& scene : shot) {
    session.edit(scene);
    pictures.push_back(diffuse_layer(session.render().image));
  }
  return pictures;
}

/// Each frame by a session of its own, with samples drawn anew.
inline std::vector<Image> resampled_pictures(const std::vector<Scene>& shot) {
  std::vector<Image> pictures;
  for (std::size_t f = 0; f < shot.size(); ++f) {
    Scene scene = shot[f];
    scene.settings.seed = f;
    pictures.push_back(carried_pictures({scene})[0]);
  }
  return pictures;
}

/// The same shot with 16 times the samples (given by number) and a tenth of the tolerance: what changes in it
/// is the scene.
inline std::vector<Image> reference_pictures(std::vector<Scene> shot) {
  for (Scene& scene : shot) {
    scene.settings.samples = 16 * scene.settings.samples.value();
    scene.settings.tolerance /= 10;
    scene.settings.seed = 1000;
  }
  return carried_pictures(shot);
}

/// What a frame's pixels change to the next beyond the reference's change, (b - a) - (reference b -
/// reference a): R G B, 0 where one of the frames does not show the object, and A: where all do.
inline Image own_change(const Image& a, const Image& b, const Image& reference_a, const Image& reference_b) {
  Image change = a;
  for (std::size_t i = 0; i < change.pixels.size(); i += 4) {
    bool shown = true;
    for (const Image* image : {&a, &b, &reference_a, &reference_b}) shown &= image->pixels[i + 3] == 1;
    for (std::size_t c = i; c < i + 3; ++c)
      change.pixels[c] =
          shown ? (b.pixels[c] - a.pixels[c]) - (reference_b.pixels[c] - reference_a.pixels[c]) : 0;
    change.pixels[i + 3] = shown ? 1 : 0;
  }
  return change;
}

/// Mean over frames, pixels and channels of |own change|, over the reference's mean there.
inline double flicker(const std::vector<Image>& pictures, const std::vector<Image>& reference) {
  double change = 0, signal = 0;
  for (std::size_t f = 0; f + 1 < pictures.size(); ++f) {
    const Image own = own_change(pictures[f], pictures[f + 1], reference[f], reference[f + 1]);
    for (std::size_t i = 0; i < own.pixels.size(); ++i)
      if (i % 4 < 3 && own.pixels[i / 4 * 4 + 3] == 1) {
        change += double(std::abs(own.pixels[i]));
        signal += double(reference[f].pixels[i]);
      }
  }
  return change / signal;
}

/// What the scene itself changes from frame to frame: the same of the reference alone.
inline double whole_change(const std::vector<Image>& reference) {
  const std::vector<Image> still(reference.size(), reference[0]);
  return flicker(still, reference);
}

}  // namespace opaline::test
