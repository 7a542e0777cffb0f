// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance from the viewer's side: paths start at the surface against the light, go in through the boundary,
// scatter, leave, and bring back the radiance of what they meet outside. It has nothing of `volume` but its rays
// and the phase function: other random numbers, other normals, analog flights and boundaries.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "geometry/ray_scene.h"
#include "transport/henyey_greenstein.h"
#include "transport/medium.h"

namespace opaline::test {

class CameraPaths {
 public:
  struct Setup {
    const RayScene& rays;
    const World& world;
    std::size_t body_meshes;   ///< the first ones; all others are black
    HomogeneousMedium medium;  ///< per world unit
    bool reenter = true;
    /// Radiance that arrives from a direction at a point outside, if no mesh is in the way.
    std::function<double(const Vec3d& point, const Vec3d& towards)> light;
    /// Whether a point is inside the union of the body's meshes: where they overlap.
    std::function<bool(const Vec3d&)> is_inside = {};
    /// Where the medium differs from place to place; `medium` is then at least as dense as any.
    std::function<HomogeneousMedium(const Vec3d&)> medium_at = {};
  };

  CameraPaths(Setup setup, std::uint64_t seed) : setup_(std::move(setup)), engine_(seed) {}

  double uniform() { return std::generate_canonical<double, 53>(engine_); }

  struct Place {
    Vec3d position, normal;
  };

  /// A place of the body's meshes, evenly spread.
  Place any_place() {
    if (areas_.empty()) {
      double sum = 0;
      for (std::size_t m = 0; m < setup_.body_meshes; ++m)
        for (std::size_t t = 0; t < setup_.world.meshes[m].triangles.size(); ++t) {
          areas_.push_back(sum += .5 * length(normal_of(m, t)));
          triangles_.emplace_back(m, t);
        }
    }
    const auto found = std::ranges::upper_bound(areas_, uniform() * areas_.back());
    const auto& [m, t] = triangles_[std::min(triangles_.size() - 1, std::size_t(found - areas_.begin()))];
    const Mesh& mesh = setup_.world.meshes[m];
    const auto& [i, j, k] = mesh.triangles[t];
    const double r = std::sqrt(uniform()), v = uniform();
    return {mesh.positions[i] * (1 - r) + mesh.positions[j] * (r * (1 - v)) + mesh.positions[k] * (r * v),
            normalized(normal_of(m, t))};
  }

  /// An estimate of the exitance at a place: its mean over many calls is M, W per square unit; 0 within the body.
  double exitance(const Place& place) {
    if (setup_.is_inside && setup_.is_inside(place.position + place.normal * step())) return 0;
    const double cosine = std::sqrt(uniform());
    const Vec3d towards = around(place.normal, cosine);  // where the viewer is
    const std::optional<Vec3d> in = refracted(-towards, place.normal, 1 / setup_.medium.eta);
    if (!in) return 0;
    const double enters = 1 - reflectance(cosine, std::abs(dot(*in, place.normal)), setup_.medium.eta);
    return std::numbers::pi * enters * from_inside(place.position - place.normal * step(), *in);
  }

 private:
  struct Met {
    double distance;
    Vec3d position, normal;
    bool is_body;
  };

  double step() const { return 1e-5 * setup_.world.diagonal; }

  Vec3d normal_of(std::size_t m, std::size_t t) const {
    const Mesh& mesh = setup_.world.meshes[m];
    const auto& [i, j, k] = mesh.triangles[t];
    return cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]);
  }

  std::optional<Met> meet(const Vec3d& from, const Vec3d& direction) const {
    TracedRay traced{Ray(Vec3f(from), Vec3f(direction)), {}};
    setup_.rays.intersect(std::span(&traced, 1));
    if (traced.hit.mesh == Hit::kMiss) return {};
    const double distance = double(traced.ray.far);
    return Met{distance, from + direction * distance,
               normalized(normal_of(traced.hit.mesh, traced.hit.triangle)),
               traced.hit.mesh < setup_.body_meshes};
  }

  // Against the light: scattering is the same both ways.
  double from_inside(Vec3d position, Vec3d direction) {
    const HomogeneousMedium& medium = setup_.medium;
    const double sigma_t = medium.sigma_a + medium.sigma_s;
    double through = 1, flown = 0, goal = -std::log1p(-uniform());  // optical distances
    for (;;) {
      const std::optional<Met> met = meet(position, direction);
      if (!met) return 0;  // a hole
      if (flown + sigma_t * met->distance > goal) {
        position += direction * ((goal - flown) / sigma_t);
        const HomogeneousMedium here = setup_.medium_at ? setup_.medium_at(position) : medium;
        const double event = uniform() * sigma_t;
        const bool is_real = event < here.sigma_t();
        if (is_real && event >= here.sigma_s) return 0;
        if (is_real) direction = scattered(direction, medium.g);
        flown = 0;
        goal = -std::log1p(-uniform());
        continue;
      }
      flown += sigma_t * met->distance;
      if (!met->is_body) return 0;
      const Vec3d beyond = met->position + direction * (2 * step());
      const bool is_sheet_within =
          dot(met->normal, direction) < 0 || (setup_.is_inside && setup_.is_inside(beyond));
      if (is_sheet_within) {
        position = beyond;
        continue;
      }
      const std::optional<Vec3d> out = refracted(direction, -met->normal, medium.eta);
      const double reflected =
          out ? reflectance(dot(*out, met->normal), dot(direction, met->normal), medium.eta) : 1;
      if (uniform() < reflected) {
        direction = direction - met->normal * (2 * dot(direction, met->normal));
        position = met->position - met->normal * step();
        continue;
      }
      Vec3d from = met->position + met->normal * step(), towards = *out;
      const std::optional<double> arrived = from_outside(from, towards);
      if (arrived) return through * *arrived;
      position = from;
      direction = towards;
      flown = 0;
      goal = -std::log1p(-uniform());
    }
  }

  // Radiance of the light that a path meets outside; none: it went in again, there and that way.
  std::optional<double> from_outside(Vec3d& from, Vec3d& towards) {
    for (;;) {
      const std::optional<Met> met = meet(from, towards);
      if (!met) return setup_.light(from, towards);
      if (!met->is_body || !setup_.reenter) return 0;
      const std::optional<Vec3d> in = refracted(towards, met->normal, 1 / setup_.medium.eta);
      const double cosine = -dot(towards, met->normal);
      if (cosine <= 0) return 0;
      const double reflected = in ? reflectance(cosine, -dot(*in, met->normal), setup_.medium.eta) : 1;
      if (uniform() >= reflected) {
        from = met->position - met->normal * step();
        towards = *in;
        return {};
      }
      towards = towards + met->normal * (2 * cosine);
      from = met->position + met->normal * step();
    }
  }

  // Against `normal` (unit, on the side the ray comes from); ratio: index here over there.
  static std::optional<Vec3d> refracted(const Vec3d& direction, const Vec3d& normal, double ratio) {
    const double cosine = -dot(direction, normal), k = 1 - ratio * ratio * (1 - cosine * cosine);
    if (k < 0) return {};
    return normalized(direction * ratio + normal * (ratio * cosine - std::sqrt(k)));
  }

  // Unpolarised, by both cosines; eta: of the side of the second over that of the first.
  static double reflectance(double cosine, double other, double eta) {
    const double s = (cosine - eta * other) / (cosine + eta * other),
                 p = (eta * cosine - other) / (eta * cosine + other);
    return .5 * (s * s + p * p);
  }

  Vec3d around(const Vec3d& axis, double cosine) {
    const Vec3d other = std::abs(axis.x) < .7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d x = normalized(cross(axis, other)), y = cross(axis, x);
    const double angle = 2 * std::numbers::pi * uniform(),
                 sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return normalized(axis * cosine + x * (sine * std::cos(angle)) + y * (sine * std::sin(angle)));
  }

  Vec3d scattered(const Vec3d& direction, double g) {
    return around(direction, sample_henyey_greenstein(g, uniform()));
  }

  Setup setup_;
  std::mt19937_64 engine_;
  std::vector<double> areas_;
  std::vector<std::pair<std::size_t, std::size_t>> triangles_;
};

}  // namespace opaline::test
