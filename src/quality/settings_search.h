// SPDX-License-Identifier: GPL-3.0-or-later
// Settings tried one after the other, each by a small picture of the scene itself.
#pragma once

#include <cstdint>
#include <memory>

#include "session/session_records.h"

namespace opaline {

struct SettingsSearch {
  Session& session;
  Scene scene;  ///< with the settings that are tried
  Monitor* monitor = nullptr;
  double area = 0, most_samples = 0;  ///< area and most samples of all groups; mm^2
  double probe_pixels = 96 * 96;      ///< errors may be in a few pixels alone, beside the edge of a shadow
  std::size_t enough_points = 3000;   ///< enough points of a probe, lit and translucent
  std::uint64_t pictures = 0;
  double estimated = 0;  ///< mean relative error of the last picture, by its own `error` layer
  /// Light between things, where there is any: gathered for the first picture, and for all others too.
  std::shared_ptr<const BouncedPlaces> bounced = {};
  double bounced_seconds = 0;  ///< CPU of that

  /// Settings that the search itself needs: the evaluator is not left open; edits the session, and learns the
  /// area and the most samples of all groups.
  void begin(double tolerance);

  /// Takes the scene as it is now, and prepares it.
  void prepare();

  /// The same with so many samples of all groups together.
  void place(double samples);

  /// A probe of the scene as it is now; no two share a random number of a shadow ray.
  Image picture();
  Image picture_of(double samples);

  /// A probe of what is prepared, with as many pixels from now on as it takes to see enough.
  Image first_picture();

  /// Samples that the session's plan has, of all groups.
  std::size_t planned_samples() const;

  /// Prepares what the scene's evaluator `automatic` would use; whether that is a surface cache.
  bool try_surface_cache();
};

/// Tolerance of the evaluator, for an error of the whole picture.
double tolerance_for(double error);

/// Pixels of a probe that show lit translucent surface.
std::size_t translucent_points(const Image& picture);

}  // namespace opaline
