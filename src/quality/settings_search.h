// SPDX-License-Identifier: GPL-3.0-or-later
// Search over settings with small images of the scene.
#pragma once

#include <cstdint>
#include <memory>

#include "session/session_records.h"

namespace opaline {

/// Order of the error in the number of samples.
inline constexpr double kUsualSlope = .8;

struct SettingsSearch {
  Session& session;
  Scene scene;  ///< with the settings tried
  Monitor* monitor = nullptr;
  double area = 0, most_samples = 0;  ///< sums over all bodies; mm^2
  double probe_pixels = 96 * 96;      ///< errors may be in a few pixels only, beside shadow edges
  std::size_t enough_points = 3000;   ///< enough lit translucent points of a probe
  std::uint64_t pictures = 0;
  double estimated = 0;  ///< mean relative error of the last image, by its own `error` layer
  /// Indirect light, if any: gathered for the first image and reused.
  std::shared_ptr<const BouncedPlaces> bounced = {};
  double bounced_seconds = 0;  ///< CPU of gathering it

  /// Sets the search's own settings, with a definite evaluator; edits the session, and determines area and
  /// most samples of all bodies.
  void begin(double tolerance);

  /// Edits the session to the current scene, and prepares it.
  void prepare();

  /// The same with this number of samples of all bodies together.
  void place(double samples);

  /// A probe of the current scene; no two share a random number of a shadow ray.
  Image picture();
  Image picture_of(double samples);

  /// A probe of the prepared scene; increases the resolution of all later ones until enough points are
  /// visible.
  Image first_picture();

  /// Samples in the session's plan, of all bodies.
  std::size_t planned_samples() const;

  /// Prepares the choice of the evaluator `automatic`; true if it is a surface cache.
  bool try_surface_cache();
};

/// Tolerance of the evaluator, for an error of the whole image.
double tolerance_for(double error);

/// Number of pixels of a probe with a lit translucent surface.
std::size_t translucent_points(const Image& picture);

}  // namespace opaline
