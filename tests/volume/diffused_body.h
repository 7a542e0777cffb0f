// SPDX-License-Identifier: GPL-3.0-or-later
// A lit body by diffusion in its cells.
#pragma once

#include "irradiance/irradiance.h"
#include "volume/lit_body.h"
#include "volume/nearest_sample.h"
#include "volume/volume_diffusion.h"

namespace opaline::test {

inline std::array<HomogeneousMedium, 3> grey(const HomogeneousMedium& medium) {
  return {medium, medium, medium};
}

inline std::vector<Light> lights_of(const LitBody& body, const LightSource& source) {
  return {recentred({"light", source}, body.world.origin, body.world.unit)};
}

/// Entered irradiance at the samples.
inline std::vector<LightTransfer> transfers_of(const LitBody& body, const LightSource& source, double eta) {
  return compute_irradiance({body.rays, body.surface.samples, lights_of(body, source), eta, 256, 5, nullptr});
}

/// At the samples that the body has from now on, where cells cut its surface.
/// in    media, cell: in mm; inside: in the world's space and unit
inline VolumeExitance diffused(LitBody& body, std::array<HomogeneousMedium, 3> media,
                               const LightSource& source, double cell, int parts = 1,
                               const MediaInside& inside = {}) {
  CutSurface cut = cut_surface(body.world, body.meshes, cell / body.world.unit, parts);
  body.surface = std::move(cut.surface);
  for (HomogeneousMedium& medium : media) {
    medium.sigma_a *= body.world.unit;
    medium.sigma_s *= body.world.unit;
  }
  const std::vector<LightTransfer> transfers = transfers_of(body, source, media[0].eta);
  const VolumeDiffusion cells(
      {body.world, body.meshes, body.surface.samples, cut.normals, media, cell / body.world.unit, inside});
  return cells.exitance(lights_of(body, source), transfers);
}

inline double entered_mean(const LitBody& body, const LightSource& source, double eta) {
  const std::vector<LightTransfer> transfers = transfers_of(body, source, eta);
  double sum = 0;
  for (std::size_t i = 0; i < body.surface.samples.size(); ++i)
    sum += double(body.surface.samples[i].area) * double(transfers[0].weights[i]);
  return sum / body.surface.area;
}

/// Means over coarser cells, those of other samples.
inline std::vector<double> means_over(const std::vector<SurfaceSample>& cells, const LitBody& body,
                                      const VolumeExitance& solved) {
  const NearestSample nearest(cells, &body.world);
  std::vector<double> means(cells.size()), areas(cells.size());
  for (std::size_t i = 0; i < solved.exitance.size(); ++i) {
    const SurfaceSample& s = body.surface.samples[i];
    const std::uint32_t cell = nearest.at(s.position, s.normal);
    means[cell] += double(s.area) * double(solved.exitance[i].x);
    areas[cell] += double(s.area);
  }
  for (std::size_t c = 0; c < means.size(); ++c) means[c] /= areas[c];
  return means;
}

}  // namespace opaline::test
