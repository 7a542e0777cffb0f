// SPDX-License-Identifier: GPL-3.0-or-later
// A body with samples and a light, for what computes the light that leaves it.
#pragma once

#include "opaline/lights/light.h"
#include "opaline/volume/volume_diffusion.h"
#include "opaline/volume/volume_exitance.h"
#include "support/surfaces.h"
#include "volume/volume_test.h"

namespace opaline::test {

struct LitBody {
  World world;
  RayScene rays;
  std::vector<std::uint32_t> meshes;
  SurfaceSamples surface;

  LitBody(const ShapeSource& shape, std::size_t samples, NormalMode normals = NormalMode::smooth)
      : LitBody(std::vector{shape}, samples, normals) {}
  /// Shapes that are one body.
  LitBody(const std::vector<ShapeSource>& shapes, std::size_t samples,
          NormalMode normals = NormalMode::smooth)
      : world(world_of(shapes, normals)), rays(world) {
    for (std::uint32_t m = 0; m < world.meshes.size(); ++m) meshes.push_back(m);
    surface = sample_surface({world, meshes, samples});
  }

  HomogeneousMedium in_units(HomogeneousMedium medium) const {
    medium.sigma_a *= world.unit;
    medium.sigma_s *= world.unit;
    return medium;
  }
  std::vector<Light> lights_of(const LightSource& source) const {
    return {recentred({"light", source}, world.origin, world.unit)};
  }

  /// medium: lengths in mm
  VolumeExitance walked(const HomogeneousMedium& medium, const LightSource& source,
                        std::optional<double> until_error = {}) const {
    const HomogeneousMedium own = in_units(medium);
    return volume_exitance(
        {rays, world, meshes, surface.samples, {own, own, own}, lights_of(source), until_error, 7, nullptr});
  }

  /// Entered irradiance at the samples, per light.
  std::vector<LightTransfer> transfers(const LightSource& source, double eta) const {
    return compute_irradiance({rays, surface.samples, lights_of(source), eta, 256, 5, nullptr});
  }
  /// cell: mm
  VolumeExitance diffused(const std::array<HomogeneousMedium, 3>& media, const LightSource& source,
                          double cell) const {
    const std::vector<LightTransfer> transfer = transfers(source, media[0].eta);
    const VolumeDiffusion body({world,
                                meshes,
                                surface.samples,
                                {in_units(media[0]), in_units(media[1]), in_units(media[2])},
                                cell / world.unit});
    return body.exitance(lights_of(source), transfer);
  }

  /// Mean over samples that `counts`, and its standard error as if cells were independent.
  template <class Counts>
  WalkedValue mean_where(const VolumeExitance& exitance, const Counts& counts) const {
    double area = 0, sum = 0, square = 0;
    for (std::size_t i = 0; i < surface.samples.size(); ++i) {
      const SurfaceSample& s = surface.samples[i];
      if (!counts(s)) continue;
      area += double(s.area);
      sum += double(s.area) * double(exitance.exitance[i].x);
      square += std::pow(double(s.area) * double(exitance.error[i].x), 2);
    }
    return {sum / area, std::sqrt(square) / area};
  }
};

inline const auto everywhere = [](const SurfaceSample&) { return true; };

}  // namespace opaline::test
