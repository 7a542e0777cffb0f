// SPDX-License-Identifier: GPL-3.0-or-later
// The profile of one channel, tabulated by random walks in its own medium.
#pragma once

#include <cstddef>
#include <type_traits>

#include "diffusion/reduced_medium.h"
#include "diffusion/table_profile.h"

namespace opaline {

/// R_d of random walks in diffuse light (laboratory.h), with the exact total: the exitance of diffusely lit
/// surfaces. The walks scatter isotropically, with the reduced coefficients. Deterministic: one medium always
/// has the same bits.
struct TabulatedProfile : TableProfile {
  double absorbed = 1, eta = 1;  ///< absorbed and eta of the medium
};

/// Collisions for a table, about; bench_profiles prints the time.
inline constexpr double kWalkedCollisions = 6e6;
/// Number of media with cached tables in the process.
inline constexpr std::size_t kWalkedShapesKept = 64;

/// True if the process has cached the medium's table.
bool has_walked_table(double absorbed, double eta);
/// Stores a table computed by another process.
void take_walked_table(double absorbed, double eta, RadialTable table);

/// Profile for make_channel_profile (diffuse_profile.h). Traces no walks.
TabulatedProfile make_profile(const ReducedMedium& medium, std::type_identity<TabulatedProfile>);

}  // namespace opaline
