// SPDX-License-Identifier: GPL-3.0-or-later
// Cache keys of stages, shared by the disk cache and the session.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodies/body.h"
#include "cache/stage_key.h"

namespace opaline {

/// Keys of a mesh of the world, after loading, repair and transformation: of its positions only (for
/// shadows), and with the normals; and its bounding sphere.
struct MeshKeys {
  StageKey shape, all;
  Vec3d center{};
  double radius = 0;
};
/// Instruction set and ray tracer, as results depend on them.
const char* widest_instructions();
std::string embree_version();

/// Keys of one mesh.
MeshKeys mesh_keys(const Mesh& mesh);
/// Keys of each mesh of the world.
std::vector<MeshKeys> mesh_keys(const World& world);

/// Key of the placement of a body's samples on any surface: their number and the random numbers.
StageKey placement_key(const PrecomputeInput& input, std::size_t group);
/// Cache key of a body's placed samples: its meshes and their placement.
StageKey samples_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes, std::size_t group);

/// Cache key of a body's samples on cells cutting its meshes.
/// in    unit: of the world, mm
StageKey cut_surface_key(const BodyPlan& group, std::span<const MeshKeys> meshes, double unit);

/// Cache key of the samples with key `from`, carried along to the body's current meshes.
/// in    unit: unit of their world over that of this one
StageKey carried_samples_key(const StageKey& from, const BodyPlan& group, std::span<const MeshKeys> meshes,
                             double unit);

/// Cache key of the light transmitted at samples from one light: the samples, position and size of the light
/// without its colour, the index of refraction, random numbers, and every mesh possibly shadowing the body
/// from this light. Includes Embree's version and the machine's instruction set, which affect shadow rays.
/// in    light: recentred
StageKey transfer_key(const PrecomputeInput& input, const StageKey& samples, std::span<const MeshKeys> meshes,
                      std::size_t group, const Light& light);

/// Cache key of the light transmitted at samples from all lights: each light's transfer and colour, and the
/// tint (tint_key).
StageKey transmitted_key(const StageKey& samples, std::span<const StageKey> transfers,
                         std::span<const Light> lights, const StageKey& tint);

/// Adds fuzz without its colour, as light past the fuzz is independent of it, unless its weight is 0: a scene without fuzz
/// keeps its keys.
void add_fuzz(KeyBuilder& key, const Fuzz& fuzz);
/// The same, with the coordinates of its textures on some meshes.
void add_fuzz(KeyBuilder& key, const Scene& scene, const World& world, const Fuzz& fuzz,
              std::span<const std::uint32_t> meshes);
/// Adds the normal and bump maps of meshes, unless they have none.
void add_maps(KeyBuilder& key, const Scene& scene, const World& world, std::span<const std::uint32_t> meshes);
/// Adds a medium's coefficients and radial profile.
void add_profile(KeyBuilder& key, const Medium& medium);
/// Cache key of the shape of a profile from random walks, in mean free paths.
StageKey walked_profile_key(const WalkedMedium& medium);

/// Cache key of all light from surfaces, except the exitance of bodies: meshes, opaque surfaces, lights.
/// in    lights: recentred
StageKey surfaces_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes,
                      std::span<const Light> lights);

/// Cache key of camera hits: the camera, the film, all meshes, and the build of the ray structure.
StageKey view_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes);

/// Cache key: surface type at each camera hit, including lights in front of surfaces, and random numbers for
/// light samples there, but not boundaries (HeldView::set_fields).
/// in    lights: recentred
StageKey view_surfaces_key(const PrecomputeInput& input, std::span<const Light> lights);
/// Cache key of irradiance at surface points, by light, independent of the camera.
/// in    surfaces: view_surfaces_key
StageKey view_near_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes,
                       const StageKey& surfaces);
/// Cache key of specular reflection, in addition to view_near_key.
StageKey view_coats_key(const Scene& scene);

/// Cache key of the visibility of one light: its position and size, but not its colour.
/// in    light: recentred
StageKey view_light_key(const Light& light);

/// True if a mesh could lie between a light and a body's meshes, from the bounding spheres of all;
/// conservative.
/// in    light: recentred; unit: World::unit
bool may_shadow(std::span<const MeshKeys> meshes, std::uint32_t mesh, const BodyPlan& group,
                const Light& light, double unit);

}  // namespace opaline
