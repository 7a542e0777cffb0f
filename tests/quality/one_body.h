// SPDX-License-Identifier: GPL-3.0-or-later
// A body of some 10 mm in one light, of so few pixels that it is rendered many times.
#pragma once

#include "session/session_test.h"

namespace opaline::test {

/// By hierarchical evaluation. pixels: of the picture's sides
inline Scene one_body(ShapeSource source, const Medium& medium, const Light& light, int pixels) {
  Scene scene = single_shape(std::move(source), medium, 1);
  scene.lights = {light};
  scene.camera.position = {10, 25, 45};
  scene.film.resolution = {pixels, pixels};
  scene.settings.method = Method::hierarchical;
  return scene;
}

/// Shadows itself.
inline Scene marble_torus(int pixels) {
  return one_body(TorusShape{{}, 10, 4}, marble(), point_light({30, 40, 10}, {1e4, 1e4, 1e4}), pixels);
}

}  // namespace opaline::test
