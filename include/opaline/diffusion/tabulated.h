// SPDX-License-Identifier: GPL-3.0-or-later
// The profile of one channel by random walks through its own medium.
#pragma once

#include <memory>
#include <type_traits>

#include "opaline/diffusion/radial_table.h"
#include "opaline/diffusion/reduced_medium.h"

namespace opaline {

/// The shape of the profile of a half space, in mean free paths: walked when it is first asked for.
/// Deterministic: the same medium has the same bits, whatever was asked for before. What was walked is kept for the
/// process (the last kShapesKept media).
class WalkedShape {
 public:
  static constexpr std::size_t kShapesKept = 64;
  /// About as many collisions are walked: some .8 s of CPU (bench_profiles prints the seconds).
  static constexpr double kCollisions = 6e6;

  WalkedShape(double absorbed, double eta);
  ~WalkedShape();

  double absorbed() const;
  double eta() const;
  const RadialTable& table() const;

  /// The table of a medium, where it has been walked or handed over; else null.
  static std::shared_ptr<const RadialTable> find(double absorbed, double eta);
  /// Hands over a table that was walked by another process.
  static void hand_over(double absorbed, double eta, RadialTable table);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// R_d as walks in diffuse light have it (laboratory.h), with the exact total (half_space.h): what diffusely lit
/// surfaces send out. Medium and walks scatter evenly, with the reduced coefficients.
struct TabulatedProfile {
  double mean_free_path = 0;  ///< 1/sigma_t', mm
  double total = 0;           ///< exact
  double decay = 0;           ///< kappa, the exact decay of light far from its source, per mean free path
  std::shared_ptr<const WalkedShape> shape;  ///< not walked yet
};

/// For make_channel_profile (diffuse_profile.h). Walks nothing.
TabulatedProfile make_profile(const ReducedMedium& medium, std::type_identity<TabulatedProfile>);
/// R_d(r), 1/mm^2, per entered flux, r > 0 in mm (infinite at 0).
double diffuse_reflectance_profile(const TabulatedProfile& profile, double r);
/// The share of the entered flux that leaves within r, mm.
double diffuse_reflectance_within(const TabulatedProfile& profile, double r);
/// half_space_albedo.
double total_diffuse_reflectance(const TabulatedProfile& profile);
/// As that of ChannelProfile; by the table.
double sample_diffusion_distance(const TabulatedProfile& profile, double beyond);
/// As that of ChannelProfile; by bisection.
double sample_chord_sphere_radius(const TabulatedProfile& profile, double u, double v);
/// kappa / l, 1/mm.
double slowest_decay(const TabulatedProfile& profile);

}  // namespace opaline
