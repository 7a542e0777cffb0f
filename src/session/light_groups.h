// SPDX-License-Identifier: GPL-3.0-or-later
// Contribution of each light to an image.
#pragma once

#include <string>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// A light of the scene, with the channels of one environment combined; or the backdrop, last, without lights.
struct LightGroup {
  std::string layer;  ///< name of the light, with "_" for characters invalid in compositors
  std::vector<std::size_t> lights;
  bool is_seen = false;  ///< visible to camera rays
};

/// The scene's lights, as layers.
/// error Error{bad_input}: no lights, two of the same layer, or a noisy method: `direct`, `volume`
std::vector<LightGroup> light_groups(const Scene& scene);

/// Appends "diffuse_NAME", "specular_NAME" and, for visible lights, "emission_NAME" to the session's image:
/// the contribution of that light alone, bounced light included. They sum to R, G, B within float rounding.
/// Each is an image with all other lights dark; since trees are approximate, each pixel's contributions are
/// scaled to the image's sum, by factors within the evaluator's tolerance of 1, or within the noise beside
/// shadow edges. Each light costs as much as a change of its colour; a single light nothing.
/// in    picture: from session.render()
/// error as Session::render and light_groups; the session's scene is restored
void add_light_groups(Session& session, Image& picture, Monitor* monitor = nullptr);

}  // namespace opaline
