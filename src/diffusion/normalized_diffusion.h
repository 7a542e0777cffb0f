// SPDX-License-Identifier: GPL-3.0-or-later
// The normalized diffusion profile of one channel (Christensen & Burley 2015), by one of four fits of its
// length.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "diffusion/reduced_medium.h"

namespace opaline {

/// R_d(r) = A (exp(-r/d) + exp(-r/3d)) / (8 pi d r); includes single scattering. A is the exact albedo
/// (half_space.h).
struct NormalizedDiffusion {
  double total = 0;  ///< A
  double d = 0;      ///< shape length, mm
};

/// Knots of the table of NormalizedDiffusionFit::refit (bench_normalized_diffusion). Other etas use the
/// nearest row.
inline constexpr std::array<double, 7> kRefitEtas{.75, 1, 1.15, 1.3, 1.5, 2, 3};
inline constexpr std::size_t kRefitAbsorptions = 11;  ///< fourth root of 1 - alpha': 0, 0.1, ... 1

/// Diffuse entry fit d = l / (1.9 - A + 3.5 (A - 0.8)^2), l = mean free path in mm, A in [0, 1].
NormalizedDiffusion make_normalized_diffusion(double mean_free_path, double total);

/// Profile for make_channel_profile (diffuse_profile.h), by the medium's fit:
/// diffuse_entry  make_normalized_diffusion
/// searchlight    d = l / (1.85 - A + 7 |A - 0.8|^3)
/// dmfp           d = l_d / (3.5 + 100 (A - 0.33)^4), l_d = l sqrt((2 - alpha') / (3 (1 - alpha'))); infinite without
///                absorption, so 1 - alpha' is at least 1e-8
/// refit          d by a table over absorption and eta
NormalizedDiffusion make_profile(const ReducedMedium& medium, std::type_identity<NormalizedDiffusion>);
/// R_d(r), 1/mm^2, r > 0 in mm (infinite at 0).
double diffuse_reflectance_profile(const NormalizedDiffusion& profile, double r);
/// A (1 - exp(-r/d)/4 - 3 exp(-r/3d)/4).
double diffuse_reflectance_within(const NormalizedDiffusion& profile, double r);
/// A.
double total_diffuse_reflectance(const NormalizedDiffusion& profile);
/// Samples as those of ChannelProfile: Golubev's closed form, and a sum of two gamma distributions.
double sample_diffusion_distance(const NormalizedDiffusion& profile, double beyond);
double sample_chord_sphere_radius(const NormalizedDiffusion& profile, double u, double v);
/// 1/(3d), 1/mm.
double slowest_decay(const NormalizedDiffusion& profile);

}  // namespace opaline
