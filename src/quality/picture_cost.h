// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of a whole image, predicted from small parts of it.
#pragma once

#include <vector>

#include "quality/settings_search.h"
#include "quality/time_budget.h"

namespace opaline {

/// CPU of shading the whole picture, by a few of its own tiles: points of a small picture lie wider apart,
/// and what is evaluated together costs more there.
class ShadingCost {
 public:
  /// probe: of this scene; where it shows what tells which tiles stand for the others
  ShadingCost(const Scene& scene, const Image& probe);

  /// s, of the search's scene with what its session has prepared; light between things is there.
  double of(const SettingsSearch& search);

 private:
  struct Tile {
    double coverage = 0;  // by what is to be shaded
    Rectangle pixels{};
  };
  std::vector<Tile> tiles_;  // tiles of the image, by coverage
  std::size_t tried_;        // number of tried tiles, spread evenly
};

/// CPU of what follows a picture, by a small one, s. The first call of `finish` may cost more than later
/// ones.
double finishing_cost(const Image& probe, const Film& film, const FinishPicture& finish);

/// Every few pixels of a picture, so about so many are left.
Image thinned(const Image& picture, double pixels);

/// Planned fraction of the available time; the rest covers underestimates.
inline constexpr double kPlannedShare = 0.93;

}  // namespace opaline
