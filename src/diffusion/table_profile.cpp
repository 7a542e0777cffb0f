// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/table_profile.h"

#include <cmath>

namespace opaline {

double diffuse_reflectance_profile(const TableProfile& p, double r) {
  const double l = p.mean_free_path;
  if (l == 0) return 0;
  return r > 0 ? p.total * p.shape->get().table.density(r / l) / (l * l) : INFINITY;
}

double diffuse_reflectance_within(const TableProfile& p, double r) {
  if (r <= 0) return 0;
  return p.mean_free_path == 0 ? p.total : p.total * p.shape->get().table.within(r / p.mean_free_path);
}

double total_diffuse_reflectance(const TableProfile& p) {
  return p.total;
}

double sample_diffusion_distance(const TableProfile& p, double beyond) {
  return p.mean_free_path == 0 ? 0 : p.mean_free_path * p.shape->get().table.radius_beyond(beyond);
}

double sample_chord_sphere_radius(const TableProfile& p, double u, double) {
  return p.mean_free_path == 0 ? 0 : p.mean_free_path * p.shape->get().table.chord_radius_beyond(1 - u);
}

double slowest_decay(const TableProfile& p) {
  return p.mean_free_path > 0 ? p.decay / p.mean_free_path : 0;
}

}  // namespace opaline
