// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/ray_offset.h"
#include "image/picture_module.h"
#include "opaline/image/texture_file.h"
#include "opaline/lights/environment_picture.h"
#include "opaline/lights/light.h"
#include "opaline/lights/light_tree.h"
#include "opaline/render/direct.h"
#include "opaline/render/picture_warnings.h"
#include "opaline/render/precompute.h"
#include "opaline/render/render.h"
#include "opaline/render/surface_caches.h"
#include "opaline/render/surface_textures.h"
#include "opaline/scene/names.h"
#include "opaline/volume/volume_diffusion.h"
#include "opaline/volume/volume_exitance.h"
#include "opaline/volume/walk_memory.h"
#include "render/body_groups.h"
#include "render/check_reach.h"
#include "render/light_distance.h"
#include "render/local_media.h"
#include "render/plan_samples.h"
#include "render/seen_pixels.h"

namespace opaline {
namespace {

/// A body that is thinner than its samples are apart, on the whole: they stand in rows, and miss what light
/// does across.
void warn_of_thin_body(const GroupPlan& group, std::vector<std::string>& warnings) {
  const double thickness = group.thickness;
  if (!(thickness > 0 && thickness < group.spacing)) return;
  warnings.push_back(
      fmt::format("{}: it is {:.3g} mm thick in the mean and its samples are {:.3g} mm apart: they cannot "
                  "tell its sides apart; "
                  "take {:.2g} samples (settings.samples, settings.max_samples)",
                  group.name, thickness, group.spacing, group.area / (thickness * thickness)));
}

/// Whether the cells of volume_diffusion suit a body; else its radial profile answers for it.
/// out   why not; empty: they do
std::string reason_against_cells(const Scene& scene, const World& world, const GroupPlan& group) {
  if (!(group.smallest_mean_free_path > 0)) return "it has no mean free path: diffuse reflection";
  const auto is_open = [&](std::uint32_t mesh) { return world.reports[mesh].open_edges > 0; };
  if (std::ranges::any_of(group.meshes, is_open)) return "its mesh is open and encloses no volume";
  if (!varies_inside(scene.media[group.medium], Method::volume_diffusion) &&
      is_too_large_for_cells(scene.settings, group))
    return fmt::format(
        "it takes more than {:.2g} cells of {:.3g} mean free paths, and its surface is flat on "
        "the scale of one",
        kMostCells, widest_cell(scene.settings));
  return {};
}

void leave_to_profile(const Scene& scene, const World& world, GroupPlan& group,
                      std::vector<std::string>& warnings) {
  const std::string reason = reason_against_cells(scene, world, group);
  if (reason.empty()) return;
  group.method = Method::hierarchical;
  if (group.thickness > 0 || !(group.smallest_mean_free_path > 0)) return;
  const bool is_filled = std::ranges::all_of(group.meshes, [&](std::uint32_t mesh) {
    const auto* file = std::get_if<MeshFile>(&scene.shapes[mesh].source);
    return file != nullptr && file->fill_holes;
  });
  warnings.push_back(group.name + ": " + reason +
                     "; its radial profile is used in place of volume_diffusion; close " +
                     (is_filled ? "the holes that fill_holes leaves" : "it (fill_holes)"));
}

void warn_of_near_lights(const Scene& scene, const World& world, const GroupPlan& group,
                         std::vector<std::string>& warnings) {
  for (const Light& light : scene.lights) {
    if (emission(light) == Rgb{}) continue;
    const std::optional<double> distance = near_light_distance(light, world, group.meshes, group.spacing);
    if (!distance) continue;
    warnings.push_back(fmt::format(
        "{}: the light {} is {:.3g} mm from its surface and the samples are {:.3g} mm apart: light falls "
        "between them; move the light away or make settings.sample_spacing smaller",
        group.name, light.name, *distance < 1e-3 * group.spacing ? 0 : *distance, group.spacing));
  }
}

/// error where a method knows no light between things
void check_bounces(const Scene& scene) {
  const Method method = scene.settings.method;
  if (bounces_of(scene) == 0 || method != Method::volume) return;
  throw Error(
      ErrorKind::bad_input, scene.file, 0, 0,
      fmt::format("settings.bounces: 1: with the method {} things are lit by lights alone", name_of(method)),
      "--set settings.bounces=0, or --method volume_diffusion");
}

// The share of the area in triangles far longer than high. Samples there stand in lines, each in a block of
// the sampling's grid of its own: 330 bytes in place of some 80, measured on a ring 1e5 times thinner than
// wide.
double needle_share(const World& world, const GroupPlan& group) {
  double needles = 0, area = 0;
  for (const std::uint32_t m : group.meshes) {
    needles += world.measures[m].needle_area;
    area += world.measures[m].area;
  }
  return area > 0 ? needles / area : 0;
}

// Measured: where a cell cuts the surface, its exitance and error, while all are fitted.
constexpr std::size_t kBytesOfCutSample = 640;
// Of a cell whose medium is its own: that, and what flows to each neighbour.
constexpr double kBytesOfCellMedium = 350;
// Of a cut sample besides, where light bounces: weights kept for a second fit, that fit, what is gathered and what it brings.
constexpr std::size_t kBytesOfBouncedSample = 500;

// Measured: places of the image where bounced light is gathered, and more in corners.
constexpr std::size_t kBytesOfBouncePlaces = 12'000'000;

// Measured: what finds the cells, their fits and exitance; of each channel counts of a pass's chunks, and of each light
// sums.
constexpr std::size_t kBytesOfWalkedCell = 300, kBytesOfWalkedChannel = 64, kBytesOfWalkSums = 24;

std::string shading_stage(const Settings& settings, const Film& film, bool has_tree) {
  if (settings.method == Method::lambert) return "shading: lambert";
  if (settings.method == Method::hierarchical) return "shading: hierarchical";
  if (settings.method == Method::volume_diffusion && has_tree)
    return "shading: cells, interpolated, and hierarchical";
  if (has_cells(settings.method)) return "shading: cells, interpolated";
  if (settings.until_error)
    return fmt::format("shading: direct, until the noise is {:.3g} %", 100 * *settings.until_error);
  const std::size_t wanted = settings.entry_samples.value_or(kDefaultEntrySamples),
                    pass = entry_samples_per_pass(film);
  return fmt::format("shading: direct, {} entry samples a pixel", (wanted + pass - 1) / pass * pass);
}

std::string evaluation_stage(const Settings& settings) {
  const std::string promise = fmt::format("{:.3g} % of the exact sum", 100 * settings.tolerance);
  switch (settings.evaluator) {
    case EvaluatorKind::automatic:
      return "evaluation: dual tree, at the points of the picture or, where those are fewer, places of the "
             "surface; " +
             promise;
    case EvaluatorKind::dual_tree:
      return "evaluation: dual tree, " + promise;
    case EvaluatorKind::surface_cache:
      return "evaluation: dual tree at places of the surface, " + promise;
    case EvaluatorKind::classic:
      return fmt::format("evaluation: classic traversal, {} sr", settings.laboratory.max_solid_angle);
    case EvaluatorKind::brute_force:
      return "evaluation: brute force";
  }
  return "";
}

std::string walks_stage(const Settings& settings) {
  const std::string reentry = settings.reenter ? "; light that leaves may enter again"
                                               : "; light that has left is gone (settings.reenter)";
  if (settings.until_error)
    return fmt::format("random walks, until the noise of the cells is {:.3g} %",
                       100 * *settings.until_error) +
           reentry;
  return fmt::format("random walks, {} a sample, channel and light", kDefaultWalks) + reentry;
}

/// Of a medium whose textures could differ inside a body; else empty.
std::string medium_stage(const Medium& medium, Method method) {
  if (varies_inside(medium, method))
    return "inside, its medium is at each place that of the nearest place of the surface, by its textures";
  const bool has_color = medium.texture_mix == TextureMix::medium && medium.tint_texture;
  if (!has_color && !medium.radius_texture) return {};
  std::string text = "a radial profile has one medium throughout: ";
  if (has_color) text += "of the mean colour, its texture met as by texture_mix \"split\"";
  if (has_color && medium.radius_texture) text += ", and ";
  if (medium.radius_texture) text += "of the mean radius";
  return text + "; --method volume_diffusion follows the textures inside";
}

/// in    traced: recentred
std::string irradiance_stage(const Scene& scene, std::span<const Light> traced) {
  std::size_t lights = 0, rays = 0, drawn_from = 0;
  for (std::size_t l = 0; l < traced.size(); ++l) {
    if (l > 0 && share_rays(traced[l - 1], traced[l])) continue;
    const auto* many = std::get_if<ManyLights>(&traced[l].source);
    lights += many != nullptr ? many->tree->lights().size() : 1;
    drawn_from += many != nullptr ? many->tree->lights().size() : 0;
    rays += std::size_t(shadow_rays(traced[l], scene.settings.light_samples));
  }
  const std::string drawn = drawn_from > 0 ? fmt::format(", some to lights drawn from {}", drawn_from) : "";
  return fmt::format("irradiance: {} light(s), {} shadow ray(s) a sample{}", lights, rays, drawn);
}

void list_stages(const Scene& scene, const World& world, std::span<const Light> lights, Plan& plan) {
  const Method method = scene.settings.method;
  const bool has_tree = std::ranges::any_of(
      plan.groups, [](const GroupPlan& group) { return group.method == Method::hierarchical; });
  if (has_samples(method) && !plan.groups.empty()) {
    plan.stages.push_back(fmt::format("sampling: {} translucent group(s)", plan.groups.size()));
    if (method == Method::volume) {
      plan.stages.push_back(walks_stage(scene.settings));
    } else {
      plan.stages.push_back(irradiance_stage(scene, lights));
    }
    for (const GroupPlan& group : plan.groups)
      if (group.method == Method::volume_diffusion)
        plan.stages.push_back(
            fmt::format("diffusion: about {:.2g} cells in {}, {:.3g} mm at the surface: {:.3g} mean "
                        "free paths",
                        expected_cells(group.area, group.thickness, group.cell), group.name, group.cell,
                        group.cell / group.smallest_mean_free_path));
      else if (method == Method::volume_diffusion)
        plan.stages.push_back(group.name +
                              " by a radial profile: " + reason_against_cells(scene, world, group));
    for (const GroupPlan& group : plan.groups)
      if (const Medium& medium = scene.media[group.medium]; !medium_stage(medium, method).empty())
        plan.stages.push_back(group.name + ": " + medium_stage(medium, method));
    if (has_tree) {
      plan.stages.push_back("octree");
      plan.stages.push_back(evaluation_stage(scene.settings));
    }
  }
  if (bounces_of(scene) > 0)
    plan.stages.push_back(
        method == Method::direct
            ? "bounces: light between things, once, by a ray from each place where light enters"
            : "bounces: light between things, once, gathered at the samples and at 64 x 64 places of the "
              "picture, more in corners");
  plan.stages.push_back(shading_stage(scene.settings, scene.film, has_tree));
}

// Measured (world.h): a quick build saves .3 us a triangle and costs 5 ns a ray of the picture, which lie
// together, and 75 ns a ray from a sample. Shadow edges bring about as many again.
RayBuild cheaper_build(const Scene& scene, std::span<const Light> lights, const Plan& plan) {
  constexpr double kSaved = 300, kPictureRay = 5, kSampleRay = 75;  // ns
  if (scene.settings.method != Method::hierarchical && scene.settings.method != Method::lambert)
    return RayBuild::careful;
  double rays = 0, samples = 0;  // rays: towards the lights from one point
  for (const Light& light : lights) rays += shadow_rays(light, scene.settings.light_samples);
  if (scene.settings.method == Method::hierarchical)
    for (const GroupPlan& group : plan.groups) samples += double(group.samples);
  const Film& film = scene.film;
  const double points =
      double(film.resolution[0]) * double(film.resolution[1]) * double(film.samples_per_pixel);
  const double lost = kPictureRay * points * (1 + rays) + kSampleRay * 2 * samples * rays;
  return lost < kSaved * double(plan.triangles) ? RayBuild::quick : RayBuild::careful;
}

// Measured: the library that reads pictures, with all that it loads.
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

/// Of environments, and of all textures at their full sizes: a camera may look at less.
std::size_t picture_bytes(const Scene& scene, const std::vector<const EnvironmentPicture*>& environments) {
  std::set<const TextureFile*> files;
  for (const Shape& shape : scene.shapes)
    for (const Texture* texture : textures_of(scene, shape)) files.insert(texture->file.get());
  // Loaded, too, where all textures turned out to be constant, or no shape uses them.
  std::size_t decoded = 0, cached = 0, held = picture_module_is_loaded() ? kBytesOfPictureReader : 0;
  for (const EnvironmentPicture* environment : environments) held += environment->memory();
  for (const TextureFile* file : files) {
    const TextureMemory memory = file->memory();
    decoded = std::max(decoded, memory.decoded);
    cached += memory.cached;
  }
  return held + decoded + (files.empty() ? 0 : std::min(cached, TextureFile::cache_limit()));
}

/// Warns where rays start visibly off surfaces, in scenes far larger than their smallest shape.
void warn_of_large_scene(const Scene& scene, const World& world, std::vector<std::string>& warnings) {
  constexpr double kVisible = 4e-3;  // of the smallest shape; above it a lit sliver shows in contact shadows
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
      "shape '{}' reaches {:.2g} mm from shape '{}', which is {:.2g} mm across: rays start up to {:.2g} "
      "mm off surfaces, and smaller shadows and gaps are wrong; make '{}' smaller or move it nearer",
      scene.shapes[farthest].name, reach(farthest), scene.shapes[smallest].name, size(smallest), offset,
      scene.shapes[farthest].name));
}

void warn_of_unused_colors(const Scene& scene, const World& world, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i];
    if (world.meshes[i].colors.empty() || uses_vertex_colors(scene, shape, world.meshes[i])) continue;
    if (std::get<MeshFile>(shape.source).vertex_colors) continue;
    warnings.push_back(
        fmt::format("shape '{}': its vertex colours are left out, for a texture gives its colour; "
                    "\"vertex_colors\": true multiplies both",
                    shape.name));
  }
}

}  // namespace

Plan make_plan(const Scene& scene, const World& world) {
  check_reach(scene, world);
  check_bounces(scene);
  const std::vector<Light> lights = recentred_lights(scene, world);
  Plan plan;
  plan.groups = find_groups(scene, world, plan.warnings);
  for (GroupPlan& group : plan.groups) group.model = planned_model(scene, group);
  plan.warnings.insert(plan.warnings.end(), scene.warnings.begin(), scene.warnings.end());
  std::set<std::string> said;  // by the first of several shapes from one file
  for (const MeshReport& report : world.reports)
    for (const std::string& warning : report.warnings)
      if (said.insert(warning).second) plan.warnings.push_back(warning);
  warn_of_unused_colors(scene, world, plan.warnings);
  warn_of_large_scene(scene, world, plan.warnings);
  if (scene.shapes.empty())
    plan.warnings.push_back("the scene has no shapes: the picture shows its surroundings");
  if (scene.lights.empty()) plan.warnings.push_back("the scene has no lights: the picture is black");
  const std::vector<const EnvironmentPicture*> environments = environments_of(scene);
  for (const EnvironmentPicture* environment : environments)
    if (!environment->warning().empty()) plan.warnings.push_back(environment->warning());
  for (std::string& text : lights_that_miss(scene, world)) plan.warnings.push_back(std::move(text));
  // Measured by bench_plan: the libraries; layers of the pixels that are not empty, and on their way to the file.
  const std::size_t seen = seen_pixels(scene, lights, world);
  plan.bytes = 60'000'000 + scene.asset_bytes + seen * 140;
  for (const Mesh& mesh : world.meshes) {
    plan.triangles += mesh.triangles.size();
    plan.bytes += mesh.positions.size() * 48 + mesh.triangles.size() * 195;  // and Embree's tree
    plan.bytes +=                                                            // as read, and mended
        2 * (mesh.uvs.size() * sizeof(CornerUvs) + mesh.tangents.size() * sizeof(CornerTangents) +
             mesh.colors.size() * sizeof(CornerColors));
  }
  plan.bytes += picture_bytes(scene, environments);
  std::size_t samples = 0;
  double walked = 0;  // one body after the other
  const double fewest = fewest_samples(plan.groups.size());
  for (GroupPlan& group : plan.groups) {
    group.method = scene.settings.method;
    const bool varies = varies_inside(scene.media[group.medium], group.method);
    // Measured for media that are one throughout.
    if (is_too_thin_for_cells(group) || varies) group.model.expected_error_of_diffusion.reset();
    if (is_too_large_for_cells(scene.settings, group)) group.model.expected_error_of_diffusion.reset();
    if (group.method == Method::volume_diffusion) leave_to_profile(scene, world, group, plan.warnings);
    if (group.method == Method::volume_diffusion) {
      choose_cells(scene, world, group, plan.warnings);
      choose_cut(scene.settings, fewest, group, plan.warnings);
      const double in_wires =
          group.thickness > 0 ? 1.2 * needle_share(world, group) * group.cell / group.thickness : 0;
      plan.bytes +=
          std::size_t(std::max(1., in_wires) * double(group.samples)) *
          (kBytesOfCutSample + 4 * lights.size() + (bounces_of(scene) > 0 ? kBytesOfBouncedSample : 0));
      plan.bytes += std::size_t((kBytesOfCell + (varies ? kBytesOfCellMedium : 0)) *
                                expected_cells(group.area, group.thickness, group.cell));
      continue;
    }
    choose_samples(scene, fewest, group, plan.warnings);
    if (group.method == Method::volume) {
      plan.bytes += group.samples *
                    (191 + kBytesOfWalkedCell + 6 * kBytesOfWalkedChannel + lights.size() * kBytesOfWalkSums);
      walked = std::max(walked,
                        expected_walk_bytes(world, group.meshes, walked_mean_free_path(scene, world, group)));
    }
    if (group.method != Method::hierarchical) continue;
    warn_of_near_lights(scene, world, group, plan.warnings);
    warn_of_thin_body(group, plan.warnings);
    // Measured at 1 and 10 million: samples, weights and tree while its nodes are written.
    plan.bytes += group.samples * (191 + 4 * lights.size() + (bounces_of(scene) > 0 ? 165 : 0));
    if (scene.settings.evaluator == EvaluatorKind::surface_cache)
      plan.bytes += expected_cache_places(group, world) * kBytesOfPlace;
    plan.bytes += std::size_t(needle_share(world, group) * double(group.samples) * 250);
    samples += group.samples;
  }
  // The lattice beside shadow edges has 56 bytes a place: about as many places as pixels there, up to its
  // finest level; and surface caches have their places, more as there are more pixels. Measured on bunnies: 30 to 60 bytes
  // a pixel, 300 to 500 a sample above; 5 to 11 MB where a pixel has several camera rays.
  plan.bytes += std::min(60 * seen, 500 * samples);
  if (samples > 0 && scene.film.samples_per_pixel > 1) plan.bytes += 5'000'000;
  if (bounces_of(scene) > 0) plan.bytes += kBytesOfBouncePlaces;
  plan.bytes += std::size_t(walked);
  plan.rays = cheaper_build(scene, lights, plan);
  list_stages(scene, world, lights, plan);
  return plan;
}

}  // namespace opaline
