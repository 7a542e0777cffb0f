// SPDX-License-Identifier: GPL-3.0-or-later
// Field of each mesh.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "methods/direct/entry_sampler.h"
#include "opaline/render/render.h"
#include "render/fields/field.h"

namespace opaline {

struct Fields {
  std::vector<std::unique_ptr<Field>> all;
  std::vector<std::size_t> of_mesh;  ///< an index into `all` for each mesh of the world
};

/// in    entry_samplers: of Method::direct, one per group; must outlive the fields, as the input and the
///       textures
Fields make_fields(const RenderInput& input, const SurfaceTextures& textures,
                   std::span<const EntrySampler> entry_samplers);

/// Shadow rays from a hit to each light with an area: the camera rays of a pixel share the setting's.
int light_samples_of_ray(const Scene& scene);

/// True if any light is directly visible or has more than one direction, so shadow rays are noisy.
bool has_area_lights(const Scene& scene);

}  // namespace opaline
