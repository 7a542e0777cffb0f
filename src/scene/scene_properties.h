// SPDX-License-Identifier: GPL-3.0-or-later
// Properties that follow from the records of a scene.
#pragma once

#include <vector>

#include "opaline/scene.h"

namespace opaline {

/// True if some of its light is reflected diffusely at its surface.
inline bool is_partly_opaque(const Medium& medium) {
  return medium.subsurface_weight < 1 || medium.weight_texture;
}

/// True if textures vary the colour, or the colour or radius, of the medium inside its bodies. Methods that use a radial
/// profile ignore this (SubsurfaceMethod::follows_textures_inside).
inline bool has_color_inside(const Medium& medium) {
  return medium.texture_mix == TextureMix::medium && medium.tint_texture;
}
inline bool varies_inside(const Medium& medium) {
  return has_color_inside(medium) || medium.radius_texture;
}

inline ProfileKind profile_kind(const Medium& medium) {
  return medium.profile.value_or(medium.chosen.kind);
}
inline double profile_thickness(const Medium& medium) {
  return medium.profile ? medium.thickness : medium.chosen.thickness;
}
inline NormalizedDiffusionFit profile_fit(const Medium& medium) {
  return medium.profile ? medium.fit : medium.chosen.fit;
}

/// How often light goes from one surface to another: Settings::bounces, or 1 where one thing that sends light back can
/// light another and the method knows of it. A body does not light itself unless it is asked for.
int bounces_of(const Scene& scene);
/// The textures of a shape and of its medium.
std::vector<const Texture*> textures_of(const Scene& scene, const Shape& shape);
/// True if a shape's mesh has to have UVs.
bool needs_uvs(const Scene& scene, const Shape& shape);
/// Grain of a shape whose boundary is rough and has one; else null.
const Grain* grain_of(const Scene& scene, const Shape& shape);

/// Surface coordinates read with a mesh: UVs, and tangents if the file has them.
enum class MeshUvs {
  unread,
  if_any,        ///< both
  required,      ///< UVs alone
  with_tangents  ///< UVs required
};
MeshUvs uvs_of(const Scene& scene, const Shape& shape);

}  // namespace opaline
