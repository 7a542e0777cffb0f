// SPDX-License-Identifier: GPL-3.0-or-later
// A small scene with something of everything, its edits, and what a session makes of them.
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "session/session_records.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {

/// Two marble balls (one translucent group each) beside each other on an opaque floor, under a point light,
/// an area light and the sun: neither ball shadows the other, and nothing bounces.
inline Scene two_balls() {
  Scene scene;
  scene.media = {marble(), grey_medium(.4, .01, 1.3)};
  scene.shapes = {translucent("left", SphereShape{{-15, 10, 0}, 10, kLeastFineness}, 0),
                  translucent("right", SphereShape{{15, 10, 0}, 10, kLeastFineness}, 1)};
  Shape floor;
  floor.name = "floor";
  floor.source = QuadShape{{-60, -1, 60}, {120, 0, 0}, {0, 0, -120}};
  scene.shapes.push_back(floor);
  scene.lights = {{"key", PointLight{{0, 100, 20}, {3e4, 2e4, 1e4}}},
                  {"panel", QuadLight{{-20, 90, 30}, {40, 0, 0}, {0, 0, 20}, {5, 6, 7}}},
                  {"sun", DirectionalLight{normalized(Vec3d{0, -2, -1}), {1, 2, 3}}}};
  scene.camera.position = {0, 30, 120};
  scene.camera.look_at = {0, 8, 0};
  scene.camera.field_of_view = 32;
  scene.film.resolution = {48, 32};
  scene.film.half = false;
  scene.settings.samples = 2500;
  scene.settings.light_samples = 6;
  scene.settings.bounces = 0;
  return scene;
}

/// Camera rays of BouncedPlaces in a picture of 24 x 16 pixels: one for each, and two more rows and columns around.
constexpr std::uint64_t kBouncedPlaces = (24 + 1 + 4) * (16 + 1 + 4);

/// Mean over the columns [x0, x1) of |a - b| of the diffuse layer, over b's mean there.
inline double difference(const Image& a, const Image& b, int x0, int x1) {
  double sum = 0, whole = 0;
  for (int y = 0; y < b.height; ++y)
    for (int x = x0; x < x1; ++x)
      for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
        sum += std::abs(double(channel(a, x, y, name)) - double(channel(b, x, y, name)));
        whole += double(channel(b, x, y, name));
      }
  return sum / whole;
}
inline double difference(const Image& a, const Image& b) {
  return difference(a, b, 0, b.width);
}

inline Transform shifted(const Vec3d& by) {
  Transform t;
  t.translation = by;
  return t;
}

}  // namespace opaline::test
