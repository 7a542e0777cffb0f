// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fields/make_fields.h"

#include <algorithm>

#include "diffusion/diffuse_profile.h"
#include "irradiance/sample_key.h"
#include "lights/light.h"
#include "lights/light_tree.h"
#include "render/fields/local_field.h"
#include "render/fields/partly_opaque_field.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

bool has_mesh(std::span<const std::uint32_t> meshes, std::size_t mesh) {
  return std::ranges::find(meshes, mesh) != meshes.end();
}

/// Body of each mesh, or null.
std::vector<const Body*> bodies_of_meshes(const RenderInput& input) {
  std::vector<const Body*> bodies(input.world.meshes.size());
  if (!method_of(input.scene.settings.method).needs_bodies()) return bodies;
  for (const Body& body : input.groups)
    for (const std::uint32_t mesh : body.plan.meshes) bodies[mesh] = &body;
  return bodies;
}

/// Common properties of the meshes of a field: one of the first two, or the boundary alone.
struct SurfaceKind {
  const Body* group = nullptr;
  const FieldSource* source = nullptr;
  OuterBoundary boundary = {};
  bool is_partly_opaque = false;
  friend bool operator==(const SurfaceKind&, const SurfaceKind&) = default;
};

SurfaceKind kind_of(const RenderInput& input, std::span<const FieldSource> sources, const Body* body,
                    std::size_t mesh, const OuterBoundary& boundary) {
  const Shape& shape = input.scene.shapes[mesh];
  if (!shape.medium) return {.boundary = boundary};
  SurfaceKind kind{.group = body,
                   .boundary = boundary,
                   .is_partly_opaque = is_partly_opaque(input.scene.media[*shape.medium])};
  for (const FieldSource& source : sources)
    if (has_mesh(source.meshes, mesh)) kind.source = &source;
  return kind;
}

std::unique_ptr<Field> make_field(const RenderInput& input, const SurfaceKind& kind,
                                  const SurfaceTextures& textures, std::span<const RgbF> albedos) {
  if (kind.group != nullptr) return method_of(kind.group->plan.method).field(input, *kind.group);
  if (kind.source != nullptr) return kind.source->make(textures, kind.boundary);
  return std::make_unique<LocalField>(input, albedos, kind.boundary);
}

std::vector<RgbF> albedos_of(const Scene& scene) {
  std::vector<Rgb> totals;
  for (const Medium& medium : scene.media) totals.push_back(make_diffuse_profile(medium).total);
  std::vector<RgbF> albedos;
  for (const Shape& shape : scene.shapes)
    albedos.emplace_back(shape.medium ? totals[*shape.medium] : shape.reflectance);
  return albedos;
}

}  // namespace

Fields make_fields(const RenderInput& input, const SurfaceTextures& textures,
                   std::span<const OuterBoundary> boundaries, std::span<const FieldSource> sources) {
  const std::vector<RgbF> albedos = albedos_of(input.scene);
  const std::vector<const Body*> bodies = bodies_of_meshes(input);
  Fields fields;
  std::vector<SurfaceKind> kinds;
  for (std::size_t mesh = 0; mesh < input.world.meshes.size(); ++mesh) {
    const SurfaceKind kind = kind_of(input, sources, bodies[mesh], mesh, boundaries[mesh]);
    const auto known = std::ranges::find(kinds, kind);
    fields.of_mesh.push_back(std::size_t(known - kinds.begin()));
    if (known != kinds.end()) continue;
    kinds.push_back(kind);
    std::unique_ptr<Field> field = make_field(input, kind, textures, albedos);
    if (kind.is_partly_opaque) field = std::make_unique<PartlyOpaqueField>(input, std::move(field));
    fields.all.push_back(std::move(field));
  }
  return fields;
}

int light_samples_of_ray(const Scene& scene) {
  const int rays = scene.film.samples_per_pixel;
  return (scene.settings.light_samples + rays - 1) / rays;
}

bool has_area_lights(const Scene& scene) {
  return !std::ranges::all_of(scene.lights, is_delta) || are_many(scene.lights);
}

void tint_entering(std::span<const HitTextures> textures, std::span<RgbF> irradiance,
                   std::span<Rgb> variance) {
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const RgbF& tint = textures[i].tint.entering;
    irradiance[i] = irradiance[i] * tint;
    if (!variance.empty()) variance[i] = variance[i] * Rgb(tint) * Rgb(tint);
  }
}

namespace {

std::vector<RgbF> from_lights(const PointIrradianceInput& lighting, HeldView::Surface* held) {
  if (held == nullptr) return irradiance_at(lighting);
  add_transfers(lighting, held->lights);
  return combine_lights(held->lights, lighting);
}

}  // namespace

std::vector<RgbF> irradiance_at_hits(const PointIrradianceInput& lighting, int samples_per_pixel,
                                     HeldView::Surface* held) {
  std::vector<std::uint64_t> keys;
  for (const std::uint64_t ray : lighting.keys)
    keys.push_back(key_in_pixel(ray, std::uint64_t(samples_per_pixel)));
  PointIrradianceInput at_hits = lighting;
  at_hits.keys = keys;
  std::vector<RgbF> irradiance = from_lights(at_hits, held);
  for (std::size_t i = 0; i < lighting.bounced.size(); ++i) irradiance[i] += lighting.bounced[i];
  return irradiance;
}

}  // namespace opaline
