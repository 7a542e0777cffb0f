// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance of one light, and formulas to hold it against, written apart from the program's.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "irradiance/irradiance.h"
#include "lights/light.h"
#include "support/surfaces.h"

namespace opaline::test {

using std::numbers::pi;

inline Light light_of(const LightSource& source) {
  return {"light", source};
}

/// White point light of intensity 1, and so on: weights are irradiance.
inline Light unit_point(const Vec3d& position) {
  return light_of(PointLight{position, Rgb(1)});
}
inline Light unit_directional(const Vec3d& direction) {
  return light_of(DirectionalLight{normalized(direction), Rgb(1)});
}
inline Light unit_sphere_light(const Vec3d& center, double radius) {
  return light_of(SphereLight{center, radius, Rgb(1)});
}
inline Light unit_quad_light(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
  return light_of(QuadLight{corner, u, v, Rgb(1)});
}
inline Light unit_surroundings() {
  return light_of(Surroundings{Rgb(1)});
}

/// A world with its rays.
struct LitWorld {
  World world;
  RayScene rays;
  explicit LitWorld(World w) : world(std::move(w)), rays(world) {}

  std::vector<LightTransfer> transfers(const std::vector<SurfaceSample>& samples,
                                       const std::vector<Light>& lights, double eta, int light_samples = 64,
                                       std::uint64_t seed = 0) const {
    std::vector<Light> moved;
    for (const Light& light : lights) moved.push_back(recentred(light, world.origin));
    return compute_irradiance({rays, samples, moved, eta, light_samples, seed});
  }

  LightTransfer transfer(const std::vector<SurfaceSample>& samples, const Light& light, double eta,
                         int light_samples = 64, std::uint64_t seed = 0) const {
    std::vector<LightTransfer> all = transfers(samples, {light}, eta, light_samples, seed);
    EXPECT_EQ(all.size(), 1u);
    EXPECT_EQ(all.at(0).weights.size(), samples.size());
    return all.at(0);
  }

  Vec3d geometric(const SurfaceSample& s) const { return Vec3d(point_of(world, s).geometric); }
  Vec3d in_world(const SurfaceSample& s) const { return Vec3d(s.position) + world.origin; }
};

/// Transmittance from outside by Snell's angles and Fresnel's sine and tangent laws.
inline double reference_transmittance(double cos_outside, double eta) {
  const double outside = std::acos(std::min(1., cos_outside)), sine = std::sin(outside) / eta;
  if (sine >= 1) return 0;
  if (outside < 1e-7) return 1 - std::pow((eta - 1) / (eta + 1), 2);
  const double inside = std::asin(sine), sum = outside + inside, difference = outside - inside;
  const double s = std::sin(difference) / std::sin(sum), p = std::tan(difference) / std::tan(sum);
  return 1 - (s * s + p * p) / 2;
}

/// cos x Ft, 0 below the horizon.
inline double entering(double cosine, double eta) {
  return cosine > 0 ? cosine * reference_transmittance(cosine, eta) : 0;
}

/// Integral of cos x Ft over the directions of a sphere light of radiance 1, midpoint rule over its cone.
inline double sphere_light_irradiance(const Vec3d& p, const Vec3d& normal, const Vec3d& center, double radius,
                                      double eta, int n = 250) {
  const Vec3d to = center - p;
  const double sin2 = radius * radius / dot(to, to), solid_cap = sin2 / (1 + std::sqrt(1 - sin2));
  Vec3d tangent, bitangent;
  tangent_frame(normalized(to), tangent, bitangent);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double down = solid_cap * (i + .5) / n, c = 1 - down, s = std::sqrt(down * (2 - down));
    for (int j = 0; j < n; ++j) {
      const double phi = 2 * pi * (j + .5) / n;
      const Vec3d d = normalized(to) * c + tangent * (s * std::cos(phi)) + bitangent * (s * std::sin(phi));
      sum += entering(dot(d, normal), eta);
    }
  }
  return sum / n / n * 2 * pi * solid_cap;
}

/// Integral of cos over a parallelogram of radiance 1 all above the horizon: Lambert's sum over its edges of
/// angle x (unit normal of the edge's plane through p) . normal / 2.
inline double quad_light_irradiance(const Vec3d& p, const Vec3d& normal, const QuadLight& q) {
  const std::array<Vec3d, 4> corners = {q.corner - p, q.corner + q.u - p, q.corner + q.u + q.v - p,
                                        q.corner + q.v - p};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = normalized(corners[i]), b = normalized(corners[(i + 1) % 4]), c = cross(a, b);
    sum += std::atan2(length(c), dot(a, b)) * dot(normalized(c), normal);
  }
  return std::abs(sum) / 2;
}

/// Rms of the difference from a reference over the reference's mean: what relative_error estimates.
inline double rms_error(const std::vector<float>& weights, const std::vector<double>& reference) {
  double squares = 0, mean = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    squares += std::pow(double(weights[i]) - reference[i], 2);
    mean += reference[i];
  }
  const double n = double(weights.size());
  return std::sqrt(squares / n) / (mean / n);
}

inline double mean_of(const std::vector<float>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.) / double(weights.size());
}

}  // namespace opaline::test
