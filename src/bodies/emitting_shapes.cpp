// SPDX-License-Identifier: GPL-3.0-or-later
// Lights of emitting shapes in the world's space.
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "bodies/body.h"
#include "bodies/surface_textures.h"
#include "geometry/ray_offset.h"
#include "lights/shape_light.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

/// A texture on the only mesh of a world.
EmittingSurface::Texels texels_of(const Texture& texture, const Shape& shape) {
  const bool is_whole = has_whole_faces(shape);
  const std::optional<SolidSpace> space = is_solid(texture) || std::ranges::any_of(texture.details, is_solid)
                                              ? std::optional(solid_space(solid_to_world(shape)))
                                              : std::nullopt;
  return
      [=](const World& world, std::uint32_t triangle, float u, float v, const std::array<Vec3f, 2>& sides) {
        SurfaceTextures::Place place{0, {}, {sides[0], sides[1]}};
        place.on_whole_face = is_whole;
        if (!world.meshes[0].uvs.empty()) place.uv = surface_uv(world.meshes[0], triangle, u, v);
        if (space) place.solid = solid_place(*space, world, 0, triangle, u, v, sides);
        return color_at(texture, place);
      };
}

/// At least the diagonal; another one only where it doubles.
double rounded_diagonal(const World& world) {
  return std::exp2(std::ilogb(world.diagonal) + 1);
}

StageKey surface_key(const Scene& scene, const World& world, std::size_t shape) {
  KeyBuilder key("emitting surface", 2);
  const Mesh& mesh = world.meshes[shape];
  key.add_array(std::span(mesh.positions)).add_array(std::span(mesh.triangles));
  key.add(rounded_diagonal(world));
  if (const std::optional<Texture>& texture = scene.shapes[shape].emission_texture) {
    add_to_key(key, *texture);
    key.add_array(std::span(mesh.uvs)).add(world.origin).add(world.unit);
    add_solid_space(key, scene, shape);
  }
  return key.key();
}

/// The same object while it is in use.
std::shared_ptr<const EmittingSurface> emitting_surface(const Scene& scene, const World& world,
                                                        std::size_t index) {
  static std::mutex mutex;
  static std::map<StageKey, std::weak_ptr<const EmittingSurface>> known;
  const StageKey key = surface_key(scene, world, index);
  const std::lock_guard lock(mutex);
  std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<const EmittingSurface>& entry = known[key];
  if (auto surface = entry.lock()) return surface;
  const Shape& shape = scene.shapes[index];
  const Mesh& mesh = world.meshes[index];
  // Twice the largest offset of a ray's origin.
  const float clearance = float(2 * rounded_diagonal(world)) * (kRayOffsetOfSize + 2 * kRayOffsetOfPosition);
  World alone;
  alone.meshes.push_back({mesh.positions, {}, mesh.triangles, mesh.uvs});
  alone.origin = world.origin;
  alone.unit = world.unit;
  auto surface = std::make_shared<const EmittingSurface>(
      std::move(alone),
      shape.emission_texture ? texels_of(*shape.emission_texture, shape) : EmittingSurface::Texels{}, key.low,
      clearance);
  entry = surface;
  return surface;
}

}  // namespace

Light light_in_world(const Scene& scene, const World& world, const Light& light) {
  Light moved = recentred(light, world.origin, world.unit);
  if (auto* const of_shape = std::get_if<ShapeLight>(&moved.source))
    of_shape->surface = emitting_surface(scene, world, of_shape->shape);
  return moved;
}

}  // namespace opaline
