// SPDX-License-Identifier: GPL-3.0-or-later
// Plan of a scene before any work: stages, samples, memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodies/body_model.h"
#include "geometry/ray_scene.h"
#include "opaline/scene.h"

namespace opaline {

/// Translucent shapes sharing samples and one tree.
struct BodyPlan {
  std::string name;                   ///< the group's name, or that of its only shape
  bool shared = false;                ///< a named group, open for other shapes, unlike a lone shape
  std::vector<std::uint32_t> meshes;  ///< indices into World::meshes
  std::size_t medium = 0;             ///< index into Scene::media
  double area = 0;                    ///< mm^2
  double thickness = 0;               ///< mean, mm: twice the volume over the area; 0 if a mesh is open
  double alignment = 0;               ///< BodyShape::alignment
  BodyModel model = {};
  /// Method of the settings, or a replacement if the body lacks its requirements.
  Method method = Method::hierarchical;
  std::string reason_against_method = {};  ///< reason for a replacement; empty: none
  double smallest_mean_free_path = 0;      ///< over the scattering channels, mm
  double spacing = 0;                      ///< sqrt(area / samples), mm
  std::size_t samples = 0;
  std::string reason;  ///< reason for this number
  double cell = 0;     ///< volume_diffusion: edge of its cells at the surface, mm
  int cell_parts = 1;  ///< divisions of the cell's edge for samples: see cut_surface
};

struct Plan {
  std::vector<BodyPlan> groups;       ///< empty: nothing translucent, no precompute
  std::vector<std::string> stages;    ///< stages to run, each with its reason
  std::vector<std::string> warnings;  ///< one line each, with the likely fix
  std::size_t bytes =
      0;  ///< expected peak: program, meshes, rays, samples, trees and an image without empty pixels
  std::size_t triangles = 0;
  RayBuild rays = RayBuild::careful;  ///< quick if that saves more than it costs the rays of one image
};

}  // namespace opaline
