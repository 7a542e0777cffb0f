// SPDX-License-Identifier: GPL-3.0-or-later
// Opaque shapes inside a body, e.g. bones or a stone: they absorb the light in it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bodies/plan.h"
#include "geometry/ray_scene.h"
#include "geometry/world.h"
#include "opaline/scene.h"
#include "volume/media_inside.h"

namespace opaline {

/// True if a ray from the point leaves the body once more often than it enters.
bool is_inside(const RayScene& rays, const BodyPlan& body, const Vec3d& point);

/// True if the vertices of the shape inside the body span a considerable part of it, more than the stem of an apple.
bool has_vertices_inside(const World& world, const RayScene& rays, const BodyPlan& body, std::uint32_t mesh);

/// True for a closed opaque shape.
bool is_opaque_solid(const Scene& scene, const World& world, std::uint32_t mesh);

/// Opaque solids, their bounding boxes meeting those of the body.
std::vector<std::uint32_t> opaque_beside(const Scene& scene, const World& world, const BodyPlan& body);

/// Those with a considerable part inside the body. Reads all vertices of the shapes beside it.
std::vector<std::uint32_t> opaque_inside(const Scene& scene, const World& world, const RayScene& rays,
                                         const BodyPlan& body);

/// A medium with opaque shapes in it, replaced there by a black one of the same extinction.
/// in    inside: of the body; empty: `throughout`, in the world's unit. World and rays outlive the result
MediaInside with_opaque_shapes(const World& world, const RayScene& rays, std::vector<std::uint32_t> meshes,
                               MediaInside inside, const std::array<HomogeneousMedium, 3>& throughout);

}  // namespace opaline
