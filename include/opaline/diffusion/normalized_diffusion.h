// SPDX-License-Identifier: GPL-3.0-or-later
// The normalized diffusion profile of one channel (Christensen & Burley 2015), with its three fits and one more.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "opaline/diffusion/reduced_medium.h"

namespace opaline {

/// R_d(r) = A (exp(-r/d) + exp(-r/3d)) / (8 pi d r); includes single scattering. A is the exact albedo
/// (half_space.h). Here d is the paper's fit for diffuse entry, to walks without a boundary: its cumulative
/// distribution is off by up to .17 at eta 1.3, .26 at 1.5.
struct NormalizedDiffusion {
  double total = 0;  ///< A
  double d = 0;      ///< shape length, mm
};

/// The paper's fit for a beam along the normal (the searchlight configuration).
struct NormalizedDiffusionSearchlight : NormalizedDiffusion {};

/// The paper's fit by the diffuse mean free path. Without absorption that is infinite: from 1 - alpha' = 1e-8
/// down it is held.
struct NormalizedDiffusionDmfp : NormalizedDiffusion {};

/// A fit of d by absorption and eta to walks behind a boundary in diffuse light (bench_normalized_diffusion).
/// Outside of the table's etas the nearest row holds.
struct NormalizedDiffusionRefit : NormalizedDiffusion {
  static constexpr std::array<double, 7> kEta{.75, 1, 1.15, 1.3, 1.5, 2, 3};
  static constexpr std::size_t kAbsorptions = 11;  ///< fourth root of 1 - alpha': 0, .1, ... 1
};

/// Diffuse entry fit d = l / (1.9 - A + 3.5 (A - 0.8)^2), l = mean free path in mm, A in [0, 1].
NormalizedDiffusion make_normalized_diffusion(double mean_free_path, double total);

/// R_d(r), 1/mm^2, r > 0 in mm (infinite at 0).
double diffuse_reflectance_profile(const NormalizedDiffusion& profile, double r);
/// A (1 - exp(-r/d)/4 - 3 exp(-r/3d)/4).
double diffuse_reflectance_within(const NormalizedDiffusion& profile, double r);
/// A.
double total_diffuse_reflectance(const NormalizedDiffusion& profile);

/// For make_channel_profile (diffuse_profile.h).
NormalizedDiffusion make_profile(const ReducedMedium& medium, std::type_identity<NormalizedDiffusion>);
/// Of its kind: d = l / (1.85 - A + 7 |A - 0.8|^3).
NormalizedDiffusionSearchlight make_profile(const ReducedMedium& medium,
                                            std::type_identity<NormalizedDiffusionSearchlight>);
/// Of its kind: d = l_d / (3.5 + 100 (A - 0.33)^4), l_d = l sqrt((2 - alpha') / (3 (1 - alpha'))).
NormalizedDiffusionDmfp make_profile(const ReducedMedium& medium,
                                     std::type_identity<NormalizedDiffusionDmfp>);
/// Of its kind.
NormalizedDiffusionRefit make_profile(const ReducedMedium& medium,
                                      std::type_identity<NormalizedDiffusionRefit>);
/// As that of ChannelProfile; Golubev's closed form.
double sample_diffusion_distance(const NormalizedDiffusion& profile, double beyond);
/// As that of ChannelProfile; a sum of two gamma distributions.
double sample_chord_sphere_radius(const NormalizedDiffusion& profile, double u, double v);
/// 1/(3d), 1/mm.
double slowest_decay(const NormalizedDiffusion& profile);

}  // namespace opaline
