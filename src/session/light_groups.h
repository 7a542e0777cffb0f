// SPDX-License-Identifier: GPL-3.0-or-later
// Contribution of each light to an image.
#pragma once

#include <string>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// A light of the scene; the channels of one environment are one.
struct LightGroup {
  std::string layer;  ///< name of the light, with "_" for characters invalid in compositors
  std::vector<std::size_t> lights;
  bool is_seen = false;  ///< camera rays may meet it
};

/// The scene's lights, as layers.
/// error Error{bad_input}: no lights, two of the same layer, or a method whose pictures are noisy: `direct`, `volume`
std::vector<LightGroup> light_groups(const Scene& scene);

/// Appends "diffuse_NAME", "specular_NAME" and, for lights that may be seen, "emission_NAME" to the picture of the
/// session's scene: what is in it by that light alone, bounced light included. They sum to R, G, B within float
/// rounding. Light is additive, so each is the picture of the scene in which the others are dark. Trees are
/// approximate, so each pixel's shares are scaled to sum to what the picture has; the factors are within the
/// evaluator's tolerance of 1, beside edges of shadows within the noise. Costs what light that changes colour costs, for
/// each light; one light costs nothing.
/// in    picture: session.render()'s
/// error as Session::render and light_groups; the session holds its scene again
void add_light_groups(Session& session, Image& picture, Monitor* monitor = nullptr);

}  // namespace opaline
