// SPDX-License-Identifier: GPL-3.0-or-later
// A body of one medium, sampled, and walked in some light.
#pragma once

#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "lights/light.h"
#include "support/surfaces.h"
#include "transport/fresnel.h"
#include "volume/volume_exitance.h"
#include "volume/volume_test.h"

namespace opaline::test {

struct LitBody {
  World world;
  RayScene rays;
  std::vector<std::uint32_t> meshes;
  SurfaceSamples surface;
  std::vector<Light> lights;
  HomogeneousMedium medium;  ///< per mm
  bool reenter = true;
  std::size_t others = 0;  ///< meshes behind the body's that stop light

  LitBody(World w, std::size_t samples, std::size_t other_meshes = 0)
      : world(std::move(w)),
        rays(world),
        meshes(world.meshes.size() - other_meshes),
        surface((std::iota(meshes.begin(), meshes.end(), 0u), sample_surface({world, meshes, samples}))),
        others(other_meshes) {}
  LitBody(const ShapeSource& shape, std::size_t samples, NormalMode normals = NormalMode::smooth)
      : LitBody(world_of({shape}, normals), samples) {}

  void light(const std::vector<LightSource>& sources) {
    for (const LightSource& source : sources)
      lights.push_back(
          recentred({"light " + std::to_string(lights.size()), source}, world.origin, world.unit));
  }

  VolumeInput input(std::uint64_t seed = 7, std::optional<double> until_error = {}) const {
    HomogeneousMedium own = medium;
    own.sigma_a *= world.unit;
    own.sigma_s *= world.unit;
    return {rays,   world,       meshes, surface.samples, {own, own, own},
            lights, until_error, seed,   nullptr,         reenter};
  }
  VolumeExitance walked(std::uint64_t seed = 7, std::optional<double> until_error = {}) const {
    return volume_exitance(input(seed, until_error));
  }

  /// Mean over samples that `counts`, and its standard error as if cells were independent.
  template <class Counts>
  WalkedValue mean_where(const VolumeExitance& exitance, const Counts& counts) const {
    double area = 0, sum = 0, square = 0;
    for (std::size_t i = 0; i < surface.samples.size(); ++i) {
      const SurfaceSample& s = surface.samples[i];
      if (!counts(s)) continue;
      area += double(s.area);
      const double outer =
          double(s.area) * (exitance.outer_shares.empty() ? 1 : double(exitance.outer_shares[i]));
      sum += outer * double(exitance.exitance[i].x);
      square += std::pow(outer * double(exitance.error[i].x), 2);
    }
    return {sum / area, std::sqrt(square) / area};
  }
};

inline bool everywhere(const SurfaceSample&) {
  return true;
}

/// Mean exitance of a body without absorption in the radiance 1 from everywhere.
inline double furnace_exitance(double eta) {
  return std::numbers::pi * (1 - average_reflectance_outside(eta));
}

}  // namespace opaline::test
