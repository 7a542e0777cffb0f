// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume_diffusion/body_cells.h"

#include <array>

#include "bodies/local_media.h"

namespace opaline {
namespace {

HomogeneousMedium isotropic_medium(const ReducedMedium& reduced) {
  const double length = reduced.mean_free_path;
  if (!(length > 0)) return {0, 0, 0, reduced.eta};
  return {reduced.absorbed / length, (1 - reduced.absorbed) / length, 0, reduced.eta};
}

/// In the world's unit.
std::array<HomogeneousMedium, 3> isotropic_media(const DiffuseProfile& profile) {
  std::array<HomogeneousMedium, 3> media;
  for (std::size_t c = 0; c < 3; ++c) {
    const double decay =
        profile.mean_free_path[c] / profile.diffuse_mean_free_path[c];  // its square is 3 (1 - alpha')
    media[c] = isotropic_medium({profile.mean_free_path[c], decay * decay / 3, profile.eta});
  }
  return media;
}

}  // namespace

// Body cells of a medium that varies, what the cells do not resolve is stretched until they do. It still returns as much light, and
// where it leaves is known within a cell, as everything is.
VolumeDiffusion body_cells(const PrecomputeInput& input, const Body& body, std::span<const Vec3f> normals) {
  const double cell = body.plan.cell / input.world.unit, least = cell / input.scene.settings.cell_size;
  const auto resolved = [least](ReducedMedium reduced) {
    const double length = length_to_resolve(reduced.mean_free_path, reduced.absorbed);
    if (!(length > 0))
      reduced.mean_free_path = least / length_to_resolve(1, reduced.absorbed);
    else if (length < least)
      reduced.mean_free_path *= least / length;
    return isotropic_medium(reduced);
  };
  return VolumeDiffusion({input.world, body.plan.meshes, body.surface.samples, normals,
                          isotropic_media(body.profile), cell, media_inside(input, body, resolved)});
}

}  // namespace opaline
