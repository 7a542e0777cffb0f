// SPDX-License-Identifier: GPL-3.0-or-later
// Field of each mesh.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "subsurface/field.h"
#include "subsurface/render_input.h"

namespace opaline {

/// Field of some meshes, from a method without bodies.
struct FieldSource {
  std::span<const std::uint32_t> meshes;
  /// in    textures: must outlive the field
  std::function<std::unique_ptr<Field>(const SurfaceTextures& textures, const OuterBoundary& boundary)> make;
};

struct Fields {
  std::vector<std::unique_ptr<Field>> all;
  std::vector<std::size_t> of_mesh;  ///< an index into `all` for each mesh of the world
};

/// in    boundaries: one per mesh; sources: of meshes without a body. All arguments but the boundaries must outlive the fields
Fields make_fields(const RenderInput& input, const SurfaceTextures& textures,
                   std::span<const OuterBoundary> boundaries, std::span<const FieldSource> sources);

/// Shadow rays from a hit to each light with an area: the camera rays of a pixel share the setting's.
int light_samples_of_ray(const Scene& scene);

/// True if any light is directly visible or has more than one direction, so shadow rays are noisy.
bool has_area_lights(const Scene& scene);

}  // namespace opaline
