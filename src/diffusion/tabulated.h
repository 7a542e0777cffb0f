// SPDX-License-Identifier: GPL-3.0-or-later
// The profile of one channel, tabulated by random walks in its own medium.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "diffusion/reduced_medium.h"
#include "diffusion/table_profile.h"

namespace opaline {

/// Medium of a table, lengths in mean free paths.
struct WalkedMedium {
  double absorbed = 1, eta = 1;
  std::vector<FlatLayer> layers = {};  ///< empty: homogeneous; in mean free paths of the equivalent medium
  friend bool operator==(const WalkedMedium&, const WalkedMedium&) = default;
};

/// R_d of random walks in diffuse light (laboratory.h), with the exact total: the exitance of diffusely lit
/// surfaces. The walks scatter isotropically, with the reduced coefficients. Deterministic: one medium always
/// has the same bits.
struct TabulatedProfile : TableProfile {
  WalkedMedium medium;
};

/// Collisions for a table, about; bench_profiles prints the time.
inline constexpr double kWalkedCollisions = 6e6;
/// Number of media with cached tables in the process.
inline constexpr std::size_t kWalkedShapesKept = 64;

/// True if the process has cached the medium's table.
bool has_walked_table(const WalkedMedium& medium);
/// Stores a table computed by another process.
void take_walked_table(const WalkedMedium& medium, RadialTable table);

/// Profile for make_channel_profile (diffuse_profile.h). Traces no walks.
TabulatedProfile make_profile(const ReducedMedium& medium, std::type_identity<TabulatedProfile>);
/// Profile of a stack of layers. Traces no walks.
/// in    layers: in any unit of length, the same as equivalent.mean_free_path (layered_medium.h)
TabulatedProfile make_layered_profile(std::span<const FlatLayer> layers, const ReducedMedium& equivalent);

}  // namespace opaline
