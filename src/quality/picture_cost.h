// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of a whole image, predicted from small parts of it.
#pragma once

#include <vector>

#include "quality/settings_search.h"
#include "quality/time_budget.h"

namespace opaline {

/// CPU of shading the whole image, from a few of its own tiles: points of a smaller image would be sparser
/// and cost more when evaluated together.
class ShadingCost {
 public:
  /// probe: of this scene; its covered pixels select the representative tiles
  ShadingCost(const Scene& scene, const Image& probe);

  /// CPU for the search's scene with the session's prepared stages, s, without gathering bounced light.
  double of(const SettingsSearch& search);

 private:
  struct Tile {
    double coverage = 0;  // by shaded points
    Rectangle pixels{};
  };
  std::vector<Tile> tiles_;  // tiles of the image, by coverage
  std::size_t tried_;        // number of tried tiles, spread evenly
};

/// CPU of `finish` on the full image, predicted from a small one, s. The first call may cost more than later
/// ones.
double finishing_cost(const Image& probe, const Film& film, const FinishPicture& finish);

/// Subsamples the pixels of an image to about this number.
Image thinned(const Image& picture, double pixels);

/// Planned fraction of the available time; the rest covers underestimates.
inline constexpr double kPlannedShare = 0.93;

}  // namespace opaline
