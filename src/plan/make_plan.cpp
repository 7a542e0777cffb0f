// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/make_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "bodies/body.h"
#include "bodies/surface_textures.h"
#include "geometry/coincident_shapes.h"
#include "geometry/ray_offset.h"
#include "geometry/world.h"
#include "image/picture_module.h"
#include "image/texture_file.h"
#include "lights/environment_picture.h"
#include "lights/light.h"
#include "opaline/error.h"
#include "opaline/scene.h"
#include "plan/body_groups.h"
#include "plan/gathered_share.h"
#include "plan/other_wavelengths.h"
#include "plan/picture_warnings.h"
#include "plan/seen_pixels.h"
#include "render/render.h"
#include "scene/names.h"
#include "scene/same_place.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"
#include "subsurface/plan_samples.h"

namespace opaline {
namespace {

constexpr double kFarthest = 0x1p50, kBrightest = 1e30;

/// The largest distance of a light's points from zero, at most some times too large.
double reach_of(const Light& light) {
  const LightExtent place = extent(light);
  return place.center ? length(*place.center) + place.radius : 0;
}

void check_distance(const Scene& scene, const std::string& what, double distance, double mm) {
  if (distance <= kFarthest) return;
  throw bad_file(
      scene.file, what + " is too far from the shapes",
      fmt::format(
          "at most {:.3g} mm from their centre (2^50 times the internal unit), the limit of single precision",
          kFarthest * mm),
      fmt::format("{:.3g} mm", distance * mm));
}

/// error Error{bad_input} naming the camera or the light, and the bound: further than 2^50 units of the world
/// from its middle, or a point light of more than 1e30 W/sr per squared unit
void check_reach(const Scene& scene, const World& world) {
  if (world.meshes.empty()) return;
  check_distance(scene, "camera.position", length(into_world(world, scene.camera.position)), world.unit);
  for (const Light& light : scene.lights) {
    const Light moved = light_in_world(scene, world, light);
    const std::string name = "the light '" + light.name + "'";
    check_distance(scene, name, reach_of(moved), world.unit);
    const double brightest = max_component(emission(moved));
    if (brightest > kBrightest)
      throw bad_file(scene.file, name + " is too bright for shapes of this size",
                     fmt::format("at most {:.3g} W/sr", kBrightest * world.unit * world.unit),
                     fmt::format("{:.3g} W/sr", max_component(emission(light))));
  }
}

/// error where a method has no light between shapes
void check_bounces(const Scene& scene) {
  const Method method = scene.settings.method;
  if (bounces_of(scene) == 0 || method_of(method).supports_bounces()) return;
  throw Error(
      ErrorKind::bad_input, scene.file, 0, 0,
      fmt::format("settings.bounces is 1, but the method {} renders direct light only", name_of(method)),
      "--set settings.bounces=0, or --method volume_diffusion");
}

/// Memory for gathering bounced light: little where few rays meet a surface; bench_plan. None for methods tracing
/// paths instead.
std::size_t bytes_of_bounces(const Scene& scene, const World& world, std::size_t samples) {
  constexpr double kBuffers = 13e6, kAtSamples = 15e6, kSample = 150, kWithoutHits = .3,
                   kOfShare = .7 / kLargeShare;
  if (bounces_of(scene) == 0 || !method_of(scene.settings.method).separates_lights()) return 0;
  return std::size_t((kBuffers + std::min(kAtSamples, kSample * double(samples))) *
                     std::min(1., kWithoutHits + kOfShare * gathered_share(scene, world)));
}

/// Text for a medium with textures that could vary inside a body; else empty.
std::string medium_stage(const Medium& medium, Method method) {
  if (!medium.layers.empty()) return {};
  if (varies_inside(medium) && method_of(method).follows_textures_inside(true))
    return "textured medium: each point inside has the medium of the nearest surface point";
  const bool has_color = medium.texture_mix == TextureMix::medium && medium.tint_texture;
  if (!has_color && !medium.radius_texture) return {};
  std::string text = "a radial profile requires a homogeneous medium: ";
  if (has_color) text += "mean colour, with the texture applied as by texture_mix \"split\"";
  if (has_color && medium.radius_texture) text += ", and ";
  if (medium.radius_texture) text += "mean radius";
  return text + "; --method volume_diffusion varies the medium inside";
}

std::string layers_stage(const Medium& medium, Method method) {
  const char* const how = method_of(method).follows_textures_inside(true)
                              ? " by the depth below the nearest surface point"
                          : profile_kind(medium) == ProfileKind::tabulated
                              ? ": random walks through the stack"
                              : ": a homogeneous medium of the same reflectance and width "
                                "of scattering; \"profile\": \"tabulated\", or --method "
                                "volume_diffusion, has the layers";
  const bool is_mean = !method_of(method).follows_textures_inside(true) &&
                       std::ranges::any_of(medium.layers, [](const MediumLayer& l) {
                         return l.thickness_texture.has_value();
                       });
  return fmt::format("{} layers{}{}", medium.layers.size(), how,
                     is_mean ? "; textured thicknesses by their mean" : "");
}

void list_stages(const Scene& scene, std::span<const Light> lights, Plan& plan) {
  const SubsurfaceMethod& method = method_of(scene.settings.method);
  std::vector<Method> used;  // by bodies
  if (method.needs_samples() && !plan.groups.empty()) {
    plan.stages.push_back(fmt::format("sampling: {} translucent {}", plan.groups.size(),
                                      plan.groups.size() == 1 ? "body" : "bodies"));
    plan.stages.push_back(method.light_stage(scene, lights));
    for (const BodyPlan& group : plan.groups) {
      if (!group.reason_against_method.empty())
        plan.stages.push_back(group.name + " by hierarchical evaluation: " + group.reason_against_method);
      if (std::string text = method_of(group.method).body_stage(group); !text.empty())
        plan.stages.push_back(std::move(text));
      if (std::ranges::find(used, group.method) == used.end()) used.push_back(group.method);
    }
    for (const BodyPlan& group : plan.groups)
      if (const std::string text = medium_stage(scene.media[group.medium], group.method); !text.empty())
        plan.stages.push_back(group.name + ": " + text);
    for (const Method one : used) method_of(one).list_stages(scene, plan.stages);
  }
  for (const BodyPlan& group : plan.groups)
    if (const Medium& medium = scene.media[group.medium]; !medium.layers.empty())
      plan.stages.push_back(group.name + ": " + layers_stage(medium, group.method));
  if (bounces_of(scene) > 0)
    plan.stages.push_back(method.bounces_stage());
  else if (scene.settings.method == Method::volume && shapes_exchange_light(scene))
    plan.stages.push_back("no light between shapes; other methods leave it out with settings.bounces=0");
  else if (std::ranges::any_of(plan.groups, [&](const BodyPlan& body) { return gathers_light(scene, body); }))
    plan.stages.push_back("re-entry: light leaving the body, gathered at its samples");
  if (scene.wavelengths)
    plan.stages.push_back(scene.other_wavelengths.empty()
                              ? "spectra: 3 wavelengths in place of red, green and blue"
                              : fmt::format("spectra: {} wavelengths, three at a time",
                                            3 * (1 + scene.other_wavelengths.size())));
  if (used.empty()) used.push_back(scene.settings.method);
  std::ranges::sort(used, std::greater());
  std::string shading;
  for (const Method one : used)
    shading += (shading.empty() ? "" : ", and ") + method_of(one).shading_stage(scene);
  plan.stages.push_back("shading: " + shading);
}

// A quick build saves time per triangle, and costs time per camera ray (coherent) and per shadow ray from a
// sample (incoherent), measured on the bunny. Shadow edges need about as many rays again.
RayBuild cheaper_build(const Scene& scene, std::span<const Light> lights, const Plan& plan) {
  constexpr double kSaved = 300, kPictureRay = 5, kSampleRay = 75;  // ns
  const double samples = method_of(scene.settings.method).samples_with_shadow_rays(plan);
  if (!std::isfinite(samples)) return RayBuild::careful;
  double rays = 0;  // towards the lights from one point
  for (const Light& light : lights) rays += shadow_rays(light, scene.settings.light_samples);
  const Film& film = scene.film;
  const double points =
      double(film.resolution[0]) * double(film.resolution[1]) * double(film.samples_per_pixel);
  const double lost = kPictureRay * points * (1 + rays) + kSampleRay * 2 * samples * rays;
  return lost < kSaved * double(plan.triangles) ? RayBuild::quick : RayBuild::careful;
}

// Memory of the image-reader library and its dependencies; bench_plan.
constexpr std::size_t kBytesOfPictureReader = 105'000'000;

/// Each once, in the order of the lights.
std::vector<const EnvironmentPicture*> environments_of(const Scene& scene) {
  std::vector<const EnvironmentPicture*> environments;
  for (const Light& light : scene.lights)
    if (const auto* environment = std::get_if<EnvironmentLight>(&light.source))
      if (std::ranges::find(environments, environment->picture.get()) == environments.end())
        environments.push_back(environment->picture.get());
  return environments;
}

/// Memory of environment maps, and of all textures at full size; a camera may load less.
std::size_t picture_bytes(const Scene& scene, const std::vector<const EnvironmentPicture*>& environments) {
  std::set<const TextureSource*> sources;
  for (const Shape& shape : scene.shapes)
    for (const Texture* texture : textures_of(scene, shape)) sources.insert(texture->source.get());
  // Loaded as well if all textures turn out constant, or if no shape uses them.
  std::size_t decoded = 0, cached = 0, held = picture_module_is_loaded() ? kBytesOfPictureReader : 0;
  for (const EnvironmentPicture* environment : environments) held += environment->memory();
  bool has_images = false;
  for (const TextureSource* source : sources) {
    const TextureMemory memory = source->memory();
    decoded = std::max(decoded, memory.decoded);
    cached += memory.cached;
    has_images = has_images || source->image() != nullptr;
  }
  return held + decoded + (!has_images ? 0 : std::min(cached, TextureFile::cache_limit()));
}

/// Warns of scenes far larger than their smallest shape, whose ray offsets become visible.
void warn_of_large_scene(const Scene& scene, const World& world, std::vector<std::string>& warnings) {
  constexpr double kVisible = 4e-3;  // fraction of the smallest shape visible in contact shadows
  if (world.boxes.empty()) return;
  const auto size = [&](std::size_t m) { return length(world.boxes[m].high - world.boxes[m].low); };
  std::size_t smallest = 0, farthest = 0;
  for (std::size_t m = 0; m < world.boxes.size(); ++m)
    if (size(m) > 0 && !(size(smallest) <= size(m))) smallest = m;
  const Vec3d middle = (world.boxes[smallest].low + world.boxes[smallest].high) * .5;
  const auto reach = [&](std::size_t m) {
    return length(component_max(world.boxes[m].high - middle, middle - world.boxes[m].low));
  };
  double offset = 0;
  for (std::size_t m = 0; m < world.boxes.size(); ++m) {
    const Vec3d away = component_max(world.boxes[m].high - world.origin, world.origin - world.boxes[m].low);
    offset = std::max(offset, double(kRayOffsetOfSize) * size(m) +
                                  double(kRayOffsetOfPosition) * (away.x + away.y + away.z));
    if (reach(m) > reach(farthest)) farthest = m;
  }
  if (!(offset > kVisible * size(smallest))) return;
  warnings.push_back(fmt::format(
      "shape '{}' extends {:.2g} mm from shape '{}', which is {:.2g} mm across: rays start up to {:.2g} mm "
      "from surfaces, so smaller shadows and gaps are wrong; make '{}' smaller or move it nearer",
      scene.shapes[farthest].name, reach(farthest), scene.shapes[smallest].name, size(smallest), offset,
      scene.shapes[farthest].name));
}

void warn_of_unused_colors(const Scene& scene, const World& world, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i];
    if (world.meshes[i].colors.empty() || uses_vertex_colors(scene, shape, world.meshes[i])) continue;
    if (std::get<MeshFile>(shape.source).vertex_colors) continue;
    warnings.push_back(fmt::format(
        "shape '{}': a texture replaces the vertex colours; \"vertex_colors\": true multiplies both",
        shape.name));
  }
}

/// Peak memory of a scene at all its wavelengths: each three are prepared while about half of the results of the
/// ones before remain.
/// in    first: of the first three; without_bodies: part of it for the meshes and the image
std::size_t most_bytes(const Scene& scene, const World& world, std::size_t first,
                       std::size_t without_bodies) {
  std::size_t most = first;
  for (std::size_t g = 0; g < scene.other_wavelengths.size(); ++g)
    most = std::max(most, make_plan(at_other_wavelengths(scene, g), world).bytes);
  return most + (most - without_bodies) / 2;
}

/// The library, its filter, and the filtered layer. Fitted to 128 x 128 to 2048 x 2048 pixels.
std::size_t bytes_of_denoiser(const Film& film) {
  const Rectangle part = rendered_part(film);
  const std::size_t pixels = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  return 8'000'000 + std::min<std::size_t>(550 * pixels, 325'000'000) + 24 * pixels;
}

/// Copies of the meshes of emitting shapes, their cells, and structures for rays towards them.
std::size_t bytes_of_emitters(const Scene& scene, const World& world) {
  std::size_t bytes = 0;
  for (const Light& light : scene.lights) {
    const auto* const emitted = std::get_if<ShapeLight>(&light.source);
    if (emitted == nullptr || emitted->channel.value_or(0) != 0) continue;
    const Mesh& mesh = world.meshes[emitted->shape];
    bytes += mesh.positions.size() * 60 + mesh.triangles.size() * 350 + 200'000;
  }
  return bytes;
}

/// A second structure for camera rays, if any shape moves while the shutter is open.
std::size_t bytes_of_motion(const Scene& scene, const World& world) {
  std::size_t bytes = 0;
  bool moves = false;
  for (std::size_t i = 0; i < world.meshes.size() && !scene.shutter.empty(); ++i) {
    const std::size_t steps = (scene.shutter.size() - 1) / 2;  // pairs of them
    bytes += steps * (world.meshes[i].positions.size() * 150 + world.meshes[i].triangles.size() * 300);
    for (const ShutterPose& pose : scene.shutter)
      moves = moves || !in_same_place(pose.shapes[i], scene.shapes[i]);
  }
  return moves ? bytes : 0;
}

}  // namespace

Plan make_plan(const Scene& scene, const World& world, std::span<const BodyPlan> reference) {
  check_reach(scene, world);
  check_bounces(scene);
  const std::vector<Light> lights = recentred_lights(scene, world);
  Plan plan;
  plan.groups = find_groups(scene, world, plan.warnings);
  for (BodyPlan& group : plan.groups) group.model = planned_model(scene, world, group, plan.groups.size());
  plan.warnings.insert(plan.warnings.end(), scene.warnings.begin(), scene.warnings.end());
  std::set<std::string> said;  // reported by the first of several shapes from one file
  for (const MeshReport& report : world.reports)
    for (const std::string& warning : report.warnings)
      if (said.insert(warning).second) plan.warnings.push_back(warning);
  for (std::string& text : warnings_of_coincident_shapes(scene, world))
    plan.warnings.push_back(std::move(text));
  warn_of_unused_colors(scene, world, plan.warnings);
  warn_of_large_scene(scene, world, plan.warnings);
  if (scene.shapes.empty())
    plan.warnings.push_back("the scene has no shapes; the image shows the surroundings");
  if (scene.lights.empty()) plan.warnings.push_back("the scene has no lights: the image is black");
  const std::vector<const EnvironmentPicture*> environments = environments_of(scene);
  for (const EnvironmentPicture* environment : environments)
    if (!environment->warning().empty()) plan.warnings.push_back(environment->warning());
  for (std::string& text : lights_that_miss(scene, world)) plan.warnings.push_back(std::move(text));
  // Fitted to bench_plan: the libraries; layers of the covered pixels, and their copy on the way to the file.
  const std::size_t seen = seen_pixels(scene, lights, world);
  plan.bytes = 62'000'000 + scene.asset_bytes + seen * 140;
  for (const Mesh& mesh : world.meshes) {
    plan.triangles += mesh.triangles.size();
    plan.bytes += mesh.positions.size() * 48 + mesh.triangles.size() * 195;  // and Embree's tree
    plan.bytes +=                                                            // as read, and mended
        2 * (mesh.uvs.size() * sizeof(CornerUvs) + mesh.tangents.size() * sizeof(CornerTangents) +
             mesh.colors.size() * sizeof(CornerColors));
  }
  plan.bytes +=
      bytes_of_motion(scene, world) + bytes_of_emitters(scene, world) + picture_bytes(scene, environments);
  const std::size_t without_bodies = plan.bytes;
  std::size_t samples = 0, caches = 0;
  double temporary = 0;  // one body after the other
  const PlanningInput planning{scene, world, lights, fewest_samples(plan.groups.size()), reference};
  for (BodyPlan& group : plan.groups) {
    // Fitted for homogeneous media.
    const bool varies = varies_inside(scene.media[group.medium]) &&
                        method_of(scene.settings.method).follows_textures_inside(true);
    if (is_too_thin_for_cells(group) || varies || is_too_large_for_cells(scene.settings, group))
      group.model.expected_error_of_diffusion.reset();
    group.method = scene.settings.method;
    method_of(group.method).plan(planning, group, plan.warnings);
    const BodyMemory memory = method_of(group.method).memory(planning, group);
    plan.bytes += memory.kept;
    caches += memory.caches;
    temporary = std::max(temporary, memory.temporary);
    samples += memory.evaluated_samples;
  }
  // Upper bound by pixels and by samples, fitted to bench_plan: the irradiance lattice beside shadow edges,
  // with about as many points as pixels at its finest level, and surface caches, finer at higher resolution.
  constexpr double kStillHeld = .3;  // fraction of the bounced light's memory while surface caches are made
  const std::size_t bounces = bytes_of_bounces(scene, world, samples);
  plan.bytes += std::max(
      bounces, caches + std::min(60 * seen, 500 * samples) + std::size_t(kStillHeld * double(bounces)));
  if (samples > 0 && scene.film.samples_per_pixel > 1) plan.bytes += 5'000'000;
  plan.bytes += std::size_t(temporary);
  if (scene.film.denoise) plan.bytes += bytes_of_denoiser(scene.film);
  if (!scene.other_wavelengths.empty()) plan.bytes = most_bytes(scene, world, plan.bytes, without_bodies);
  plan.rays = cheaper_build(scene, lights, plan);
  list_stages(scene, lights, plan);
  return plan;
}
}  // namespace opaline
