// SPDX-License-Identifier: GPL-3.0-or-later
// A radial profile of one channel, from a table of its shape.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "diffusion/radial_table.h"

namespace opaline {

/// Shape of a profile, lengths in mean free paths.
struct ProfileShape {
  RadialTable table;    ///< table of integral 1
  double integral = 1;  ///< integral of the tabulated function over the plane
};

/// A shape computed by the first thread requesting it.
class LazyShape {
 public:
  using Make = std::function<std::shared_ptr<const ProfileShape>()>;
  explicit LazyShape(Make make) : make_(std::move(make)) {}

  const ProfileShape& get() const {
    std::call_once(once_, [this] { shape_ = make_(); });
    return *shape_;
  }

 private:
  Make make_;
  mutable std::once_flag once_;
  mutable std::shared_ptr<const ProfileShape> shape_;
};

/// The shape times an exact total.
struct TableProfile {
  double mean_free_path = 0;  ///< 1/sigma_t', mm
  double total = 0;           ///< total of diffuse light, exact (half_space.h)
  double decay = 0;           ///< decay of light far from its source, per mean free path
  std::shared_ptr<const LazyShape> shape;
};

/// R_d(r) of diffuse light, 1/mm^2, per transmitted flux, r > 0 in mm (infinite at 0).
double diffuse_reflectance_profile(const TableProfile& profile, double r);
/// Fraction of the transmitted diffuse light leaving within r, mm.
double diffuse_reflectance_within(const TableProfile& profile, double r);
/// Total of diffuse light: half_space_albedo.
double total_diffuse_reflectance(const TableProfile& profile);
/// Samples as those of ChannelProfile: by the table, and by bisection.
double sample_diffusion_distance(const TableProfile& profile, double beyond);
double sample_chord_sphere_radius(const TableProfile& profile, double u, double v);
/// Decay, 1/mm.
double slowest_decay(const TableProfile& profile);

}  // namespace opaline
