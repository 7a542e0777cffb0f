// SPDX-License-Identifier: GPL-3.0-or-later
// Local medium below a surface with textured colour or radius.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "bodies/body.h"
#include "bodies/layered_media.h"
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

/// Media below the surface of bodies of one medium, from the textures above: R G B, reduced, lengths in the
/// world's unit.
class LocalMedia {
 public:
  /// medium: with diffuse colour and radius, varying inside the body. Scene and world must outlive the
  /// object.
  LocalMedia(const Scene& scene, const World& world, const Medium& medium);

  /// Least radius over the mean one: a radius of 0 would make random walks endless.
  static constexpr float kLeastRadius = 1.0f / 64;

  /// in    width: edge of a square around the point, world units; textures are averaged over it
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

/// Length to be resolved by the cells of a textured body: the 10th percentile over its surface, mm.
double short_length_of(const Scene& scene, const World& world, const BodyPlan& group);

/// Medium at points inside a body: the medium of the nearest surface point, or its layer at this depth. Empty if
/// the body's medium is homogeneous.
/// in    input, body: outlive the result; centre: of the cubes, with layers; convert: maps a reduced medium to the result's
MediaInside media_inside(const PrecomputeInput& input, const Body& body, CubeCentre centre,
                         std::function<HomogeneousMedium(const ReducedMedium&)> convert);

}  // namespace opaline
