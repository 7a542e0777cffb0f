// SPDX-License-Identifier: GPL-3.0-or-later
// A medium whose colour or radius textures vary: what it is at a place.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "bodies/body.h"
#include "bodies/surface_textures.h"
#include "diffusion/reduced_medium.h"
#include "geometry/world.h"
#include "opaline/scene.h"
#include "volume/media_inside.h"

namespace opaline {

/// True if the channel is diffuse reflection: the limit of a vanishing mean free path.
inline bool is_local(const DiffuseProfile& profile, std::size_t channel) {
  return profile.total[channel] > 0 && !(profile.mean_free_path[channel] > 0);
}

/// Media below the surface of bodies of one medium, from the textures above: R G B, reduced, lengths in the world's
/// unit.
class LocalMedia {
 public:
  /// medium: one whose coefficients are an artist's, and that varies inside. Scene and world must outlive it.
  LocalMedia(const Scene& scene, const World& world, const Medium& medium);

  /// The least radius over the mean one: one of 0 would make walks endless.
  static constexpr float kLeastRadius = 1.0f / 64;

  /// in    width: of the square around the place whose mean is looked up, world units
  std::array<ReducedMedium, 3> at(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
                                  float width) const;

 private:
  double absorbed(double color) const;

  const World& world_;
  SurfaceTextures textures_;
  ArtistMedium mean_;
  double eta_;
  std::vector<double> totals_;  // totals of media with 1 - albedo' = t^2, for uniform t from 1 to 0
};

/// Length that the cells of a textured body must resolve: the 10th percentile over its surface, mm.
double short_length_of(const Scene& scene, const World& world, const GroupPlan& group);

/// Inside a body: at each point the medium of the nearest point of its surface. Empty where the body's medium is the same
/// throughout.
/// in    input, body: outlive the result; convert: what to make of a reduced medium
MediaInside media_inside(const PrecomputeInput& input, const Body& body,
                         std::function<HomogeneousMedium(const ReducedMedium&)> convert);

}  // namespace opaline
