// SPDX-License-Identifier: GPL-3.0-or-later
#include "stages/stage_keys.h"

#include <variant>

#include "bodies/surface_textures.h"
#include "geometry/embree.h"
#include "input/settings_table.h"
#include "lights/light.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

// Raise a stage's number when it computes other values from the same input (test_stage_versions).
constexpr std::uint64_t kSamplesVersion = 2, kCutSurfaceVersion = 2, kCarriedVersion = 3,
                        kTransferVersion = 5, kTransmittedVersion = 1, kWalkedProfileVersion = 1;

}  // namespace

const char* widest_instructions() {
  if (__builtin_cpu_supports("avx512f")) return "avx512";
  if (__builtin_cpu_supports("avx2")) return "avx2";
  if (__builtin_cpu_supports("avx")) return "avx";
  return __builtin_cpu_supports("sse4.2") ? "sse4.2" : "sse2";
}

std::string embree_version() {
  return RTC_VERSION_STRING;
}

MeshKeys mesh_keys(const Mesh& mesh, const std::optional<Texture>& opacity) {
  KeyBuilder shape("mesh", 1);
  shape.add_array(std::span(mesh.positions)).add_array(std::span(mesh.triangles));
  if (opacity) add_to_key(shape.add(std::string("opacity")).add_array(std::span(mesh.uvs)), *opacity);
  MeshKeys keys{shape.key(), {}, {}, 0};
  keys.all = KeyBuilder("mesh with normals", 1).add(keys.shape).add_array(std::span(mesh.normals)).key();
  const Bounds box = bounds(mesh);
  keys.center = 0.5 * (box.low + box.high);
  for (const Vec3d& p : mesh.positions) keys.radius = std::max(keys.radius, length(p - keys.center));
  return keys;
}

std::vector<MeshKeys> mesh_keys(const World& world) {
  std::vector<MeshKeys> keys;
  for (std::size_t i = 0; i < world.meshes.size(); ++i)
    keys.push_back(mesh_keys(world.meshes[i], world.opacities.empty() ? std::nullopt : world.opacities[i]));
  return keys;
}

StageKey placement_key(const PrecomputeInput& input, std::size_t group) {
  KeyBuilder key("placement", kSamplesVersion);
  key.add(std::uint64_t(input.plan.groups[group].samples)).add(std::uint64_t(group));
  return key.add(settings_in_key(KeyedStage::samples, input.scene)).key();
}

StageKey samples_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes, std::size_t group) {
  KeyBuilder key("samples", kSamplesVersion);
  key.add(placement_key(input, group));
  for (const std::uint32_t m : input.plan.groups[group].meshes) key.add(meshes[m].all);
  return key.key();
}

StageKey cut_surface_key(const BodyPlan& group, std::span<const MeshKeys> meshes, double unit) {
  KeyBuilder key("cut surface", kCutSurfaceVersion);
  key.add(group.cell / unit).add(std::uint64_t(group.cell_parts));
  for (const std::uint32_t m : group.meshes) key.add(meshes[m].all);
  return key.key();
}

StageKey carried_samples_key(const StageKey& from, const BodyPlan& group, std::span<const MeshKeys> meshes,
                             double unit) {
  KeyBuilder key("carried samples", kCarriedVersion);
  key.add(from).add(unit);
  for (const std::uint32_t m : group.meshes) key.add(meshes[m].all);
  return key.key();
}

void add_fuzz(KeyBuilder& key, const Fuzz& fuzz) {
  if (!(fuzz.weight > 0)) return;
  key.add(std::string("fuzz")).add(fuzz.weight).add(fuzz.roughness);
  for (const auto& texture : {&fuzz.weight_texture, &fuzz.roughness_texture})
    if (*texture) add_to_key(key.add(texture == &fuzz.weight_texture), **texture);
}

void add_fuzz(KeyBuilder& key, const Scene& scene, const World& world, const Fuzz& fuzz,
              std::span<const std::uint32_t> meshes) {
  add_fuzz(key, fuzz);
  if (fuzz.weight_texture || fuzz.roughness_texture) add_spaces(key, scene, world, meshes);
}

void add_maps(KeyBuilder& key, const Scene& scene, const World& world,
              std::span<const std::uint32_t> meshes) {
  for (const std::uint32_t m : meshes) {
    const Shape& shape = scene.shapes[m];
    if (!shape.normal_map && !shape.bump_map) continue;
    for (const auto& map : {&shape.normal_map, &shape.bump_map})
      if (*map) add_to_key(key.add(std::string("map")).add(m), **map);
    if (shape.bump_map) key.add(world.unit);
    add_coordinates(key, world.meshes[m]);
    add_solid_space(key, scene, m);
  }
}

StageKey transfer_key(const PrecomputeInput& input, const StageKey& samples, std::span<const MeshKeys> meshes,
                      std::size_t group, const Light& light) {
  const BodyPlan& plan = input.plan.groups[group];
  KeyBuilder key("transfer", kTransferVersion);
  key.add(embree_version()).add(std::string(widest_instructions()));
  const Medium& medium = input.scene.media[plan.medium];
  add_fuzz(key.add(samples).add(medium.eta), input.scene, input.world, medium.fuzz, plan.meshes);
  key.add(std::uint64_t(light.source.index()));
  key.add_array(std::span<const double>(geometry(light)));
  if (!is_delta(light))
    key.add(settings_in_key(KeyedStage::transfers, input.scene))
        .add(std::uint64_t(group))
        .add(light_seed(0, light));
  if (plan.cell > 0) key.add(std::string("geometric normals"));
  add_maps(key, input.scene, input.world, plan.meshes);
  for (std::uint32_t m = 0; m < meshes.size(); ++m)
    if (may_shadow(meshes, m, plan, light, input.world.unit)) key.add(meshes[m].shape);
  return key.key();
}

StageKey surfaces_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes,
                      std::span<const Light> lights) {
  KeyBuilder key("surfaces in their light", 5);
  key.add(settings_in_key(KeyedStage::surfaces, input.scene));
  for (const MeshKeys& mesh : meshes) key.add(mesh.all);
  const auto add_value = [&key](const auto& value, const auto&, SurfacePart) { key.add(value); };
  for (std::size_t i = 0; i < input.scene.shapes.size(); ++i) {
    const Shape& shape = input.scene.shapes[i];
    for_each_textured(shape, add_value);
    key.add(shape.medium.has_value()).add(shape.gloss.has_value());
    if (shape.medium) {
      const Medium& medium = input.scene.media[*shape.medium];
      for_each_textured(medium, add_value);
      add_fuzz(key.add(medium.texture_mix).add(medium.eta), medium.fuzz);
    } else if (const auto& gloss = shape.gloss) {
      key.add(gloss->eta);
    }
    add_fuzz(key, shape.fuzz);
    for (const Texture* texture : textures_of(input.scene, shape)) add_to_key(key, *texture);
    if (uvs_of(input.scene, shape) != MeshUvs::unread) add_coordinates(key, input.world.meshes[i]);
    add_solid_space(key, input.scene, i);
    if (uses_vertex_colors(input.scene, shape, input.world.meshes[i]))
      add_vertex_colors(key.add(shape.has_reflectance), input.scene, input.world.meshes[i]);
  }
  for (const Light& light : lights) key.add(view_light_key(light)).add(emission(light));
  return key.key();
}

StageKey view_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes) {
  const Camera& camera = input.scene.camera;
  KeyBuilder key("view", 3);
  key.add(camera.position).add(camera.look_at).add(camera.up).add(camera.field_of_view);
  key.add(camera.orthographic_height.value_or(0)).add(camera.shift);
  key.add(camera.aperture).add(camera.focus_distance.value_or(0)).add(camera.blades);
  key.add(input.world.origin).add(input.world.unit);
  key.add(settings_in_key(KeyedStage::view, input.scene)).add(input.plan.rays);
  for (const MeshKeys& mesh : meshes) key.add(mesh.all);
  for (std::size_t i = 0; i < input.scene.shapes.size(); ++i) {
    if (!input.scene.shapes[i].is_seen) key.add(std::string("unseen")).add(i);
    if (input.scene.shapes[i].catches_shadows) key.add(std::string("catches shadows")).add(i);
  }
  return key.key();
}

StageKey view_surfaces_key(const PrecomputeInput& input, std::span<const Light> lights) {
  KeyBuilder key("surfaces of the view", 1);
  key.add(settings_in_key(KeyedStage::view_surfaces, input.scene));
  for (const Light& light : lights)
    if (!is_delta(light)) {
      key.add(view_light_key(light));
      if (!light.is_seen) key.add(std::string("unseen"));
    }
  for (std::size_t i = 0; i < input.scene.shapes.size(); ++i) {
    const Shape& shape = input.scene.shapes[i];
    key.add(shape.medium.has_value());
    if (shape.medium) key.add(is_partly_opaque(input.scene.media[*shape.medium]));
    for (const auto& map : {&shape.normal_map, &shape.bump_map})
      if (*map) add_to_key(key, **map);
    if (shape.normal_map || shape.bump_map) add_coordinates(key, input.world.meshes[i]);
  }
  for (const BodyPlan& group : input.plan.groups) key.add_array(std::span(group.meshes));
  return key.key();
}

StageKey view_near_key(const PrecomputeInput& input, std::span<const MeshKeys> meshes,
                       const StageKey& surfaces) {
  KeyBuilder key("near fields of the view", 1);
  key.add(surfaces).add(settings_in_key(KeyedStage::view_near, input.scene)).add(input.plan.rays);
  key.add(input.world.origin).add(input.world.unit);
  for (const MeshKeys& mesh : meshes) key.add(mesh.all);
  return key.key();
}

StageKey view_coats_key(const Scene& scene) {
  KeyBuilder key("coats of the view", 1);
  const auto add_part = [&key](const auto& value, const auto&, SurfacePart part) {
    if (part == SurfacePart::boundary) key.add(value);
  };
  for (const Shape& shape : scene.shapes) {
    for_each_textured(shape, add_part);
    add_fuzz(key, shape.fuzz);
    if (!shape.medium) continue;
    const Medium& medium = scene.media[*shape.medium];
    add_fuzz(key, medium.fuzz);
    for_each_textured(medium, add_part);
  }
  return key.key();
}

StageKey view_light_key(const Light& light) {
  KeyBuilder key("light of the view", 1);
  key.add(std::uint64_t(light.source.index())).add(light_seed(0, light));
  key.add_array(std::span<const double>(geometry(light)));
  return key.key();
}

StageKey transmitted_key(const StageKey& samples, std::span<const StageKey> transfers,
                         std::span<const Light> lights, const StageKey& tint) {
  KeyBuilder key("octree", kTransmittedVersion);
  key.add(samples);
  if (tint != StageKey{}) key.add(tint);
  for (std::size_t l = 0; l < lights.size(); ++l) key.add(transfers[l]).add(emission(lights[l]));
  return key.key();
}

void add_profile(KeyBuilder& key, const Medium& medium) {
  std::visit([&](const auto& coefficients) { key.add(coefficients); }, medium.coefficients);
  key.add(std::uint64_t(medium.coefficients.index())).add(medium.eta).add(profile_kind(medium));
  if (profile_kind(medium) == ProfileKind::multipole) key.add(profile_thickness(medium));
  if (profile_kind(medium) == ProfileKind::normalized_diffusion) key.add(profile_fit(medium));
  if (profile_kind(medium) != ProfileKind::tabulated) return;
  for (const MediumLayer& layer : medium.layers)
    key.add(layer.coefficients).add(layer.thickness).add(layer.mean_factor);
}

StageKey walked_profile_key(const WalkedMedium& medium) {
  KeyBuilder key("walked profile", kWalkedProfileVersion);
  key.add(medium.absorbed).add(medium.eta);
  for (const FlatLayer& layer : medium.layers)
    key.add(layer.sigma_a).add(layer.sigma_s_prime).add(layer.thickness);
  return key.key();
}

}  // namespace opaline
