// SPDX-License-Identifier: GPL-3.0-or-later
// The laboratory: reflection and transmission of a flat half space or slab of any medium, by random walks
// with error bars.
//
// A beam enters the upper face at the origin. All fractions are of the transmitted flux; specular reflection
// at the face is excluded everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "opaline/monitor.h"
#include "transport/medium.h"

namespace opaline {

/// Medium between two smooth parallel faces, infinite sideways.
struct Slab {
  double thickness = std::numeric_limits<double>::infinity();  ///< mm, > 0; infinite: a half space
};

/// Medium of a layer, and its thickness.
struct SlabLayer {
  HomogeneousMedium medium;
  double thickness = std::numeric_limits<double>::infinity();  ///< mm, >= 0
};

/// Incident light.
struct SlabEntry {
  bool is_diffuse = false;  ///< uniform radiance over the hemisphere
  double cosine = 1;        ///< cosine of a beam with the inward normal, in (0, 1]; unused if diffuse
};
inline constexpr SlabEntry kNormalEntry{}, kDiffuseEntry{true, 1};

/// An estimate and its standard error, from kWalkBatches independent batches.
struct WalkedValue {
  double value = 0, error = 0;
};

/// Exitance in a ring around the beam.
struct WalkedRing {
  double low = 0, high = 0;  ///< distances, mm
  WalkedValue share;         ///< fraction between them
  WalkedValue within;        ///< fraction nearer than `high`
  WalkedValue profile;       ///< fraction per area: the mean of R_d(r) over the ring, 1/mm^2
};

/// Exiting light between two cosines outside.
struct WalkedCosine {
  double low = 0, high = 0;
  WalkedValue value;
};

/// Light leaving through one face.
struct WalkedFace {
  WalkedValue total, uncollided;  ///< fractions: total, and unscattered
  std::vector<WalkedRing> rings;
  WalkedValue beyond;  ///< fraction beyond the last ring
  /// Radiance over that of a Lambert emitter of the same flux, with cosine-weighted mean 1. Zero without any
  /// light.
  std::vector<WalkedCosine> angular_exit;
};

struct SlabWalks {
  std::size_t walks = 0;
  double collisions = 0;  ///< mean per walk
  double entered = 1;     ///< fraction of the incident flux entering, exact: 1 - F(cosine), or 1 - F_bar
  WalkedFace back, through;
  WalkedValue absorbed;
  WalkedValue unfinished;  ///< still inside after most_collisions
  WalkedValue energy;      ///< sum of all fractions; its expectation is 1
  /// Albedo under diffuse light by cosine of incidence: reflected fraction of the light transmitted at these
  /// cosines. Zero at total reflection.
  std::vector<WalkedCosine> albedo_by_entry;
};

inline constexpr std::size_t kWalkBatches = 512;

struct LaboratorySettings {
  std::size_t walks = 100000;  ///< > 0; rounded up to a multiple of kWalkBatches
  std::uint64_t seed = 1;
  /// Maximum collisions of one walk, > 0. Limits walks in a half space without absorption, see
  /// SlabWalks::unfinished.
  std::uint64_t most_collisions = std::uint64_t(1) << 24;
  std::vector<double> radii;  ///< outer radii of the rings, mm, ascending, > 0; empty: default_radii
  int cosine_bins = 20;       ///< cosine bins of equal width, from 1 to 10000
  Monitor* monitor = nullptr;
};

/// Ten per decade, from 0.001 to 1000 reduced mean free paths.
std::vector<double> default_radii(const HomogeneousMedium& medium);

/// Random walks through a slab. The same bits for any number of threads.
/// error Error{bad_input} naming the value out of range; Error{interrupted}
/// from  Prahl et al. 1989, A Monte Carlo model of light propagation in tissue, with expected values for
///       exiting light; tested against van de Hulst 1980 and Chandrasekhar's H functions (tests/volume)
SlabWalks walk_slab(const HomogeneousMedium& medium, const Slab& slab, const SlabEntry& entry,
                    const LaboratorySettings& settings);

/// Random walks through a stack of flat layers, from the face of entry downwards, with the index of refraction of the
/// first; they do not reflect light between each other. The same bits for any number of threads. Errors are those of
/// plain means: layers have no control variates.
/// in    layers: at least one; all but the last of finite thickness; empty layers (thickness 0) are left out
/// error as walk_slab
SlabWalks walk_layers(std::span<const SlabLayer> layers, const SlabEntry& entry,
                      const LaboratorySettings& settings);

}  // namespace opaline
