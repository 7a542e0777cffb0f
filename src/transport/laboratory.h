// SPDX-License-Identifier: GPL-3.0-or-later
// The laboratory: light on a flat half space or slab of any medium, measured by random walks with error bars.
//
// A beam falls on the upper face at the origin. All shares are of the flux that entered there; what the face
// reflects before any light enters is left out everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "opaline/monitor.h"
#include "transport/medium.h"

namespace opaline {

/// Between two smooth faces; endless sideways.
struct Slab {
  double thickness = std::numeric_limits<double>::infinity();  ///< mm, > 0; infinite: a half space
};

/// How light arrives from outside.
struct SlabEntry {
  bool is_diffuse = false;  ///< from everywhere, equal radiance
  double cosine = 1;  ///< cosine of a beam with the inward normal, in (0, 1]; not used where it is diffuse
};
inline constexpr SlabEntry kNormalEntry{}, kDiffuseEntry{true, 1};

/// An estimate and its standard error, itself estimated from kWalkBatches independent batches.
struct WalkedValue {
  double value = 0, error = 0;
};

/// Light leaving at a distance from the beam.
struct WalkedRing {
  double low = 0, high = 0;  ///< distances, mm
  WalkedValue share;         ///< that leaves between them
  WalkedValue within;        ///< that leaves nearer than `high`
  WalkedValue profile;       ///< share per area: the mean of R_d(r) over the ring, 1/mm^2
};

/// Light between two cosines outside.
struct WalkedCosine {
  double low = 0, high = 0;
  WalkedValue value;
};

/// Light leaving one face.
struct WalkedFace {
  WalkedValue total, uncollided;  ///< shares: all of it, and the part of it that was never scattered
  std::vector<WalkedRing> rings;
  WalkedValue beyond;  ///< share leaving farther away than the last ring
  /// Radiance over that of a Lambert emitter of the same flux: cosine-weighted mean 1. Zero where nothing leaves.
  std::vector<WalkedCosine> angular_exit;
};

struct SlabWalks {
  std::size_t walks = 0;
  double collisions = 0;  ///< mean of a walk
  double entered = 1;     ///< fraction of the incident flux entering, exact: 1 - F(cosine), or 1 - F_bar
  WalkedFace back, through;
  WalkedValue absorbed;
  WalkedValue unfinished;  ///< still inside after most_collisions
  WalkedValue energy;      ///< sum of all shares; its mean is 1
  /// Albedo under diffuse light by cosine of entry: fraction of the light transmitted at these cosines leaving by the
  /// entry face. Zero at total reflection.
  std::vector<WalkedCosine> albedo_by_entry;
};

/// The fraction of the incident flux for a fraction of what entered.
inline WalkedValue per_incident(const SlabWalks& walks, const WalkedValue& share) {
  return {share.value * walks.entered, share.error * walks.entered};
}

inline constexpr std::size_t kWalkBatches = 512;

struct LaboratorySettings {
  std::size_t walks = 100000;  ///< > 0; rounded up to a multiple of kWalkBatches
  std::uint64_t seed = 1;
  /// Maximum collisions of one walk, > 0. Limits walks in a half space without absorption, see SlabWalks::unfinished.
  std::uint64_t most_collisions = std::uint64_t(1) << 24;
  std::vector<double> radii;  ///< where rings end, mm, ascending, > 0; empty: default_radii
  int cosine_bins = 20;       ///< cosine bins of equal width, from 1 to 10000
  Monitor* monitor = nullptr;
};

/// Ten a decade, from .001 to 1000 reduced mean free paths.
std::vector<double> default_radii(const HomogeneousMedium& medium);

/// Walks through a slab. The same bits for any number of threads.
/// error Error{bad_input} naming what is out of range; Error{interrupted}
/// from  Prahl et al. 1989, A Monte Carlo model of light propagation in tissue, with what leaves as its expected
///       value; tested against van de Hulst 1980 and Chandrasekhar's H functions (tests/volume)
SlabWalks walk_slab(const HomogeneousMedium& medium, const Slab& slab, const SlabEntry& entry,
                    const LaboratorySettings& settings);

}  // namespace opaline
