// SPDX-License-Identifier: GPL-3.0-or-later
// Properties derived from the records of a scene.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "opaline/scene.h"

namespace opaline {

/// True if two translucent shapes share a group, and thereby samples.
bool are_one_body(const Shape& a, const Shape& b);

/// True if some of its light is reflected diffusely at its surface.
inline bool is_partly_opaque(const Medium& medium) {
  return medium.subsurface_weight < 1 || medium.weight_texture;
}

/// True if the fibres of a shape, or of its medium, scatter light.
bool has_bright_fuzz(const Scene& scene, const Shape& shape);

/// True if textures vary the medium's colour, or colour or radius, inside its bodies, or it has layers. Methods with a radial
/// profile ignore this (SubsurfaceMethod::follows_textures_inside).
inline bool has_color_inside(const Medium& medium) {
  return medium.texture_mix == TextureMix::medium && medium.tint_texture;
}
inline bool varies_inside(const Medium& medium) {
  return has_color_inside(medium) || medium.radius_texture || !medium.layers.empty();
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

/// True if one reflecting shape can illuminate another.
bool shapes_exchange_light(const Scene& scene);
/// Number of bounces between surfaces: Settings::bounces, or by default 1 if one reflecting shape can
/// illuminate another and the method supports it. A body illuminates itself only on request.
int bounces_of(const Scene& scene);
/// True if one of the shapes has a map of normals or heights.
bool has_maps(const Scene& scene, std::span<const std::uint32_t> shapes);
/// Textures of a shape and of its medium.
std::vector<const Texture*> textures_of(const Scene& scene, const Shape& shape);
/// True if a texture's values depend on the position in the space of the shape, instead of UVs.
bool is_solid(const Texture& texture);
/// From the space of solid textures, mm, to the world.
Transform solid_to_world(const Shape& shape);
/// True if a shape's mesh needs UVs.
bool needs_uvs(const Scene& scene, const Shape& shape);
/// Anisotropy of a shape's rough boundary; null for smooth or isotropic ones.
const Grain* grain_of(const Scene& scene, const Shape& shape);
/// True if the boundary of a shape is rough somewhere.
bool is_rough(const Scene& scene, const Shape& shape);

/// Surface coordinates read with a mesh: UVs, and tangents if the file has them.
enum class MeshUvs {
  unread,
  if_any,        ///< both
  required,      ///< UVs alone
  with_tangents  ///< UVs required
};
MeshUvs uvs_of(const Scene& scene, const Shape& shape);

}  // namespace opaline
