// SPDX-License-Identifier: GPL-3.0-or-later
// Which result of a scene's stages depends on what: the one notion that the disk cache and the session share.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "opaline/cache/stage_key.h"
#include "opaline/render/precompute.h"

namespace opaline {

/// Keys of a mesh of the world, after loading, mending and moving: its places alone (what throws shadows),
/// and with the normals; and a ball around it.
struct MeshKeys {
  StageKey shape, all;
  Vec3d center{};
  double radius = 0;
};
/// Instruction set and ray tracer that results depend on.
const char* widest_instructions();
std::string embree_version();

/// Keys of one mesh.
MeshKeys mesh_keys(const Mesh& mesh);
/// One a mesh of the world.
std::vector<MeshKeys> mesh_keys(const World& world);

/// Samples key of a group's samples placed anew: its meshes, their count and random numbers.
StageKey samples_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes, std::size_t group);

/// Cut surface key of a group's samples where cells cut its meshes.
/// in    unit: of the world, mm
StageKey cut_surface_key(const GroupPlan& group, std::span<const MeshKeys> meshes, double unit);

/// Carried samples key of the samples of key `from`, carried along to the group's meshes as they are now.
/// in    unit: of the world they come from over that of this one
StageKey carried_samples_key(const StageKey& from, const GroupPlan& group, std::span<const MeshKeys> meshes,
                             double unit);

/// Transfer key of the light that enters at samples from one light: the samples, where and how large the light is but not
/// its colour, the index of refraction, random numbers, and every mesh that could throw a shadow from this
/// light onto the group. Shadow rays are Embree's: its version and the machine's instruction set belong to
/// it.
/// in    light: recentred
StageKey transfer_key(const PrecomputeInput& input, const StageKey& samples, std::span<const MeshKeys> meshes,
                      std::size_t group, const Light& light);

/// Cache key of the light transmitted at samples from all lights: each light's transfer and colour, and the tint
/// (tint_key).
StageKey transmitted_key(const StageKey& samples, std::span<const StageKey> transfers,
                         std::span<const Light> lights, const StageKey& tint);

/// Walked profile key of the shape of a profile that is walked, in mean free paths.
StageKey walked_profile_key(double absorbed, double eta);

/// Surfaces key of all that lights another surface but for what bodies hold: meshes, opaque surfaces, lights.
/// in    lights: recentred
StageKey surfaces_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes,
                      std::span<const Light> lights);

/// View key of what camera rays meet: the camera, the film, all meshes, how the structure was built that rays walk.
StageKey view_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes);

/// View surfaces key of which surfaces the camera's rays meet are of which kind, lights that hide some included, and of the
/// random numbers that lights are sampled with there; but for boundaries (HeldView::set_fields).
/// in    lights: recentred
StageKey view_surfaces_key(const PrecomputeInput& input, std::span<const Light> lights);
/// View near key of irradiance at places of surfaces, by light, whatever the camera sees.
/// in    surfaces: view_surfaces_key
StageKey view_near_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes,
                       const StageKey& surfaces);
/// Besides that, of what coats mirror.
StageKey view_coats_key(const Scene& scene);

/// View light key of how one light reaches them: where it is and how large, but not its colour.
/// in    light: recentred
StageKey view_light_key(const Light& light);

/// True if a mesh could be in the way between a light and a group's meshes, to judge by the balls around them
/// all; at most too cautious.
/// in    light: recentred; unit: World::unit
bool may_shadow(std::span<const MeshKeys> meshes, std::uint32_t mesh, const GroupPlan& group,
                const Light& light, double unit);

}  // namespace opaline
