// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/diffusion/tabulated.h"

#include <cmath>

#include "opaline/transport/half_space.h"
#include "opaline/transport/point_source.h"

namespace opaline {

TabulatedProfile make_profile(const ReducedMedium& medium, std::type_identity<TabulatedProfile>) {
  return {medium.mean_free_path, half_space_albedo(medium.absorbed, medium.eta),
          decay_constant(medium.absorbed), std::make_shared<const WalkedShape>(medium.absorbed, medium.eta)};
}

double diffuse_reflectance_profile(const TabulatedProfile& p, double r) {
  const double l = p.mean_free_path;
  if (l == 0) return 0;
  return r > 0 ? p.total * p.shape->table().density(r / l) / (l * l) : INFINITY;
}

double diffuse_reflectance_within(const TabulatedProfile& p, double r) {
  if (r <= 0) return 0;
  return p.mean_free_path == 0 ? p.total : p.total * p.shape->table().within(r / p.mean_free_path);
}

double total_diffuse_reflectance(const TabulatedProfile& p) {
  return p.total;
}

double sample_diffusion_distance(const TabulatedProfile& p, double beyond) {
  return p.mean_free_path == 0 ? 0 : p.mean_free_path * p.shape->table().radius_beyond(beyond);
}

double sample_chord_sphere_radius(const TabulatedProfile& p, double u, double) {
  return p.mean_free_path == 0 ? 0 : p.mean_free_path * p.shape->table().chord_radius_beyond(1 - u);
}

double slowest_decay(const TabulatedProfile& p) {
  return p.mean_free_path > 0 ? p.decay / p.mean_free_path : 0;
}

}  // namespace opaline
