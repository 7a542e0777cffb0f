// SPDX-License-Identifier: GPL-3.0-or-later
// Octree of transmitted flux, kernel and surface cache of one body.
#pragma once

#include "bodies/body.h"
#include "exitance/evaluate.h"
#include "exitance/octree.h"
#include "exitance/surface_cache.h"
#include "stages/stage_store.h"

namespace opaline {

struct Kernels {
  SplitKernel kernel, wider;  ///< wider: CloudErrorInput::wider
};

struct HierarchicalState : MethodState {
  static constexpr Method kMethod = Method::hierarchical;
  std::vector<RgbF> irradiance;  ///< transmitted, one per sample, from lights and other surfaces
  StageResult<Octree> tree;      ///< octree of the irradiance
  StageKey direct_key;           ///< direct key of the tree before bounced light is added
  StageResult<Kernels> kernels;
  CloudError cloud = {};                    ///< error model of the octree and the kernel
  StageResult<SurfaceCache> surface_cache;  ///< may be kept though this image does not use it
  bool uses_surface_cache = false;

  const Octree& octree() const { return tree.value; }
  const SplitKernel& kernel() const { return kernels.value.kernel; }
  /// Null: the exitance is evaluated at the hits.
  const SurfaceCache* cache() const { return uses_surface_cache ? &surface_cache.value : nullptr; }
};

const HierarchicalState& hierarchical_state(const Body& body);
HierarchicalState& hierarchical_state(Body& body);

/// Octree of the transmitted flux.
/// in    irradiance: one per sample
Octree gather_flux(std::span<const SurfaceSample> samples, std::span<const RgbF> irradiance);
/// Bounds the normals of the tree's nodes if the kernel has a far side.
void bound_far_side(HierarchicalState& state);
/// Gives a body the state of an irradiance, without a surface cache or an estimate of its error.
void set_hierarchical_state(Body& body, std::vector<RgbF> irradiance, SplitKernel kernel);

/// Laboratory::near_irradiance, but from the samples if all light is uniform over directions: rays at each
/// point are as noisy as those at the samples, and there are no sharp shadows.
NearIrradiance near_irradiance(const Scene& scene);
/// Kernel of a body, split at a distance proportional to the sample spacing, mm.
SplitKernel body_kernel(const DiffuseProfile& profile, double spacing, const World& world,
                        const Scene& scene);

}  // namespace opaline
