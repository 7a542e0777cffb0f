// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_properties.h"

#include <algorithm>

#include "scene/texture_source.h"

namespace opaline {
namespace {

bool sends_light(const Scene& scene, const Shape& shape) {
  return shape.medium.has_value() || shape.reflectance != Rgb{} || has_bright_fuzz(scene, shape);
}

}  // namespace

bool has_bright_fuzz(const Scene& scene, const Shape& shape) {
  const Fuzz& fuzz = shape.medium ? scene.media[*shape.medium].fuzz : shape.fuzz;
  return fuzz.weight > 0 && fuzz.color != Rgb{};
}

bool are_one_body(const Shape& a, const Shape& b) {
  return a.medium && b.medium && !a.group.empty() && a.group == b.group;
}

bool shapes_exchange_light(const Scene& scene) {
  if (scene.lights.empty()) return false;
  const auto sends = [&](const Shape& shape) { return sends_light(scene, shape); };
  const auto first = std::ranges::find_if(scene.shapes, sends);
  return std::any_of(first, scene.shapes.end(), [&](const Shape& other) {
    return &other != &*first && sends(other) && !are_one_body(*first, other);
  });
}

int bounces_of(const Scene& scene) {
  if (scene.lights.empty()) return 0;
  if (scene.settings.bounces) return *scene.settings.bounces;
  return scene.settings.method != Method::volume && shapes_exchange_light(scene) ? 1 : 0;
}

bool has_maps(const Scene& scene, std::span<const std::uint32_t> shapes) {
  return std::ranges::any_of(
      shapes, [&](std::uint32_t s) { return scene.shapes[s].normal_map || scene.shapes[s].bump_map; });
}

std::vector<const Texture*> textures_of(const Scene& scene, const Shape& shape) {
  std::vector<const Texture*> textures;
  const auto add = [&](const auto&, const std::optional<Texture>& texture, SurfacePart) {
    if (!texture) return;
    textures.push_back(&*texture);
    for (const Texture& detail : texture->details) textures.push_back(&detail);
  };
  for_each_textured(shape, add);
  if (shape.medium) for_each_textured(scene.media[*shape.medium], add);
  return textures;
}

bool is_solid(const Texture& texture) {
  return texture.triplanar_width > 0 || texture.source->noise() != nullptr;
}

Transform solid_to_world(const Shape& shape) {
  Transform to_world = shape.to_world;
  if (const auto* mesh = std::get_if<MeshFile>(&shape.source))
    for (Vec3d* axis : {&to_world.x, &to_world.y, &to_world.z}) *axis = *axis / mesh->mm_per_unit;
  return to_world;
}

bool needs_uvs(const Scene& scene, const Shape& shape) {
  return std::ranges::any_of(textures_of(scene, shape),
                             [](const Texture* texture) { return !is_solid(*texture); });
}

bool is_rough(const Scene& scene, const Shape& shape) {
  if (shape.medium) {
    const Medium& medium = scene.media[*shape.medium];
    return medium.specular_roughness > 0 || medium.roughness_texture;
  }
  return shape.gloss && (shape.gloss->roughness > 0 || shape.gloss->roughness_texture);
}

const Grain* grain_of(const Scene& scene, const Shape& shape) {
  if (!is_rough(scene, shape)) return nullptr;
  const Grain& grain = shape.medium ? scene.media[*shape.medium].grain : shape.gloss->grain;
  return grain.anisotropy > 0 || grain.anisotropy_texture ? &grain : nullptr;
}

MeshUvs uvs_of(const Scene& scene, const Shape& shape) {
  const bool has_grain = grain_of(scene, shape) != nullptr;
  if (needs_uvs(scene, shape))
    return has_grain || shape.normal_map ? MeshUvs::with_tangents : MeshUvs::required;
  return has_grain ? MeshUvs::if_any : MeshUvs::unread;
}

}  // namespace opaline
