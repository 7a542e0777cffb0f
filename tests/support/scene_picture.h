// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene, or the text of its file, to its picture.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "core/scratch_folder.h"
#include "input/load_scene.h"
#include "methods/direct/direct.h"
#include "session/session_records.h"

namespace opaline::test {

inline Image picture_of(Session& session, const Scene& scene) {
  session.edit(scene);
  return session.render().image;
}

/// By a new session.
inline Image cold_picture(const Scene& scene) {
  Session session;
  return picture_of(session, scene);
}

inline bool same_pixels(const Image& a, const Image& b) {
  return a.channels == b.channels && a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

/// Spheres and tori of a scene with 5,120 triangles or as few, which are loaded and sampled sooner.
inline Scene with_few_triangles(Scene scene) {
  for (Shape& shape : scene.shapes) {
    if (auto* sphere = std::get_if<SphereShape>(&shape.source)) sphere->fineness = kLeastFineness;
    if (auto* torus = std::get_if<TorusShape>(&shape.source)) torus->fineness = kLeastFineness;
  }
  for (Scene& other : scene.other_wavelengths) other = with_few_triangles(std::move(other));
  return scene;
}

/// The picture of a scene file in the folder, by any method; curved shapes have few triangles.
inline Image picture_of(Session& session, const ScratchFolder& folder, const std::string& text,
                        const std::vector<std::string>& overrides = {}) {
  session.edit(with_few_triangles(parse_scene(text, folder.file("scene.json"), overrides)));
  session.prepare();
  if (session.scene().settings.method != Method::direct) return session.render().image;
  DirectState state;
  return render_direct({session.scene(), session.world(), session.rays(), session.plan()}, state)
      .picture.image;
}

/// By a new session.
inline Image picture_of(const ScratchFolder& folder, const std::string& text,
                        const std::vector<std::string>& overrides = {}) {
  Session session;
  return picture_of(session, folder, text, overrides);
}

}  // namespace opaline::test
