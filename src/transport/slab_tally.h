// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over a batch of walks, and results over many batches.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "transport/laboratory.h"
#include "transport/slab_controls.h"

namespace opaline {

/// Sums of the weight leaving through one face.
struct FaceTally {
  double total = 0, uncollided = 0;
  std::vector<double> rings;    ///< one more than radii: the last is everything beyond
  std::vector<double> cosines;  ///< outside
};

struct SlabTally {
  FaceTally back, through;
  SlabControls::Sums controls{};
  double absorbed = 0, unfinished = 0, collisions = 0;
  std::vector<double> entered,
      returned;  ///< by cosine of incidence, diffuse only: weight at the start, and returned
};

/// Tally of exiting light.
struct TallyBins {
  std::vector<double> radii, squared_radii;
  std::size_t cosines = 0;
  bool by_entry = false;

  std::size_t ring_of(double squared_radius) const;
  std::size_t cosine_of(double cosine) const;
};

TallyBins make_bins(std::vector<double> radii, std::size_t cosines, bool by_entry);

SlabTally empty_tally(const TallyBins& bins);

/// Means and standard errors, by regression on the controls, over batches of `walks_each`.
SlabWalks summarize(const TallyBins& bins, std::span<const SlabTally> batches, std::size_t walks_each);

}  // namespace opaline
