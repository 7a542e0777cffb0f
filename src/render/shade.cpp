// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluate/crease_error.h"
#include "evaluate/surface_patch.h"
#include "opaline/diffusion/fresnel.h"
#include "render/direct_exitance.h"
#include "render/selection_bias.h"

namespace opaline {
namespace {

constexpr float kInversePi = float(std::numbers::inv_pi);

Appearance appearance_of(const RenderInput& input, std::span<const EntrySampler> entry_samplers,
                         std::size_t mesh) {
  const Shape& shape = input.scene.shapes[mesh];
  Appearance appearance;
  appearance.albedo = RgbF(shape.reflectance);
  if (!shape.medium) return appearance;
  const DiffuseProfile profile = make_diffuse_profile(input.scene.media[*shape.medium]);
  appearance = {true, RgbF(profile.total), float(profile.eta), float(profile.average_reflectance)};
  const auto has_mesh = [mesh](const std::vector<std::uint32_t>& meshes) {
    return std::ranges::find(meshes, mesh) != meshes.end();
  };
  if (input.scene.settings.method == Method::hierarchical)
    for (const TranslucentGroup& group : input.groups)
      if (has_mesh(group.plan.meshes)) appearance.group = &group;
  for (const EntrySampler& sampler : entry_samplers)
    if (has_mesh(sampler.meshes())) appearance.entries = &sampler;
  return appearance;
}

// Radiance in the view direction over the exitance.
float radiance_of_exitance(const Appearance& a, float cos_view) {
  if (!a.translucent) return kInversePi;
  return kInversePi * fresnel_transmittance(cos_view, a.eta) / (1 - a.average_reflectance);
}

// By the shading normal. On coarse meshes it can be at right angles to the view, or turned away from it,
// where the triangle is seen well: a boundary that lets nothing through. So at least half of the triangle's
// cosine.
float cos_view(const SurfacePoint& point, const Vec3f& direction) {
  const float side = dot(point.geometric, direction), shading = dot(point.normal, direction);
  const float towards = side > 0 ? shading : -shading;
  return std::min(1.0f, std::max(towards, 0.5f * std::abs(side)) / length(direction));
}

SurfacePoint point_of(const Hit& hit, const RayScene& rays) {
  return rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
}

// Of the rays that hit something.
std::vector<SurfacePoint> points_of(std::span<const TracedRay> traced, const RayScene& rays) {
  std::vector<SurfacePoint> points;
  for (const auto& [ray, hit] : traced)
    if (hit.mesh != Hit::kMiss) points.push_back(point_of(hit, rays));
  return points;
}

// Irradiance at the points, by shadow rays unless they are held.
std::vector<RgbF> irradiance(const PointIrradianceInput& lighting, HeldView::Surface* held) {
  if (held == nullptr) return irradiance_at(lighting);
  held->lights.resize(lighting.lights.size());
  for (std::size_t l = 0; l < held->lights.size(); ++l)
    if (held->lights[l].weights.empty()) held->lights[l] = transfers_at(lighting, l);
  return combine_lights(held->lights, lighting);
}

// Whether pictures trace shadow rays for the exitance of a group.
bool needs_irradiance(const TranslucentGroup& group) {
  return group.surface_cache ? group.surface_cache->needs_irradiance() : group.kernel.needs_irradiance();
}

// What a near field misses beside creases, over the exitance, as a standard deviation.
RgbF crease_deviation(const TranslucentGroup& group, const RenderInput& input) {
  const Vec3f eye(into_world(input.world, input.scene.camera.position));
  const std::array<float, 3> error =
      crease_error({group.octree, group.kernel, group.profile, eye, input.scene.settings.instruction_set});
  return RgbF{error[0], error[1], error[2]} * std::sqrt(float(std::numbers::pi) / 2);
}

}  // namespace

Shader::Shader(const RenderInput& input, std::span<const EntrySampler> entry_samplers) : input_(input) {
  for (const Light& light : input.scene.lights) {
    lights_.push_back(recentred(light, input.world.origin, input.world.unit));
    if (is_delta(light)) continue;
    (extent(light).center ? emitters_ : surroundings_).push_back(lights_.back());
  }
  for (const TranslucentGroup& group : input.groups) {
    near_fields_.emplace_back();
    if (needs_irradiance(group)) near_fields_.back().emplace(group);
    creases_.push_back(crease_deviation(group, input));
  }
  for (std::size_t m = 0; m < input.world.meshes.size(); ++m) {
    Appearance appearance = appearance_of(input, entry_samplers, m);
    const Kind kind{appearance.group, appearance.entries, appearance.translucent ? appearance.eta : 0};
    const auto known = std::ranges::find(kinds_, kind);
    appearance.kind = std::size_t(known - kinds_.begin());
    if (known == kinds_.end()) kinds_.push_back(kind);
    appearances_.push_back(appearance);
  }
}

std::size_t Shader::shade(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                          std::span<PixelSample> out, const Pass& pass, HeldView::Batch* held) const {
  std::size_t queries = 0;
  if (held != nullptr) held->surfaces.resize(kinds_.size());
  const std::vector<Surfaces> surfaces = collect(rays, keys, out, held);
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    if (surfaces[k].points.empty()) continue;
    write(surfaces[k],
          light(kinds_[k], surfaces[k], rays, pass, held != nullptr ? &held->surfaces[k] : nullptr), rays,
          out);
    if (kinds_[k].eta > 0 && has_visible_lights()) add_mirrored_lights(surfaces[k], rays, out);
    if (kinds_[k].group != nullptr) queries += surfaces[k].points.size();
  }
  return queries;
}

// Sorts the hits by kind; rays that meet a light or nothing are done.
std::vector<Shader::Surfaces> Shader::collect(std::span<const TracedRay> rays,
                                              std::span<const std::uint64_t> keys, std::span<PixelSample> out,
                                              HeldView::Batch* held) const {
  std::vector<Surfaces> surfaces(kinds_.size());
  const bool holds_points = held != nullptr && input_.view->has_room;
  if (holds_points && held->points.empty()) held->points = points_of(rays, input_.rays);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [ray, hit] = rays[i];
    if (hit.mesh != Hit::kMiss) ++hits;
    const EmitterHit emitter = nearest_emitter(ray.origin, ray.direction, ray.far);
    if (emitter.hit) {
      out[i].emitted = emitter.radiance;
    } else if (hit.mesh == Hit::kMiss) {
      out[i].emitted = surroundings(ray.direction);
    } else {
      const Appearance& appearance = appearances_[hit.mesh];
      Surfaces& own = surfaces[appearance.kind];
      if (own.points.empty()) {
        own.points.reserve(rays.size());
        own.keys.reserve(rays.size());
        own.rays.reserve(rays.size());
      }
      SurfacePoint point = holds_points ? held->points[hits - 1] : point_of(hit, input_.rays);
      // An opaque sheet has two equal sides; a translucent one is lit and seen from outside.
      if (!appearance.translucent && dot(point.geometric, ray.direction) > 0) {
        point.geometric = -point.geometric;
        point.normal = -point.normal;
      }
      own.points.push_back(point);
      own.keys.push_back(keys[i]);
      own.rays.push_back(std::uint32_t(i));
    }
  }
  return surfaces;
}

Shader::Lit Shader::light(const Kind& kind, const Surfaces& surfaces, std::span<const TracedRay> rays,
                          const Pass& pass, HeldView::Surface* held) const {
  if (kind.group != nullptr) return evaluated(kind, surfaces, rays, held);
  if (kind.entries != nullptr)
    return {direct_exitance({*kind.entries, lighting_of(surfaces, kind.eta), pass.entry_samples}),
            {},
            {},
            {},
            {}};
  PointIrradianceInput lighting = lighting_of(surfaces, kind.eta);
  if (input_.scene.settings.method != Method::hierarchical)
    return {{}, irradiance(lighting, held), {}, {}, {}};
  Lit lit;
  lit.error.resize(surfaces.points.size());
  if (has_visible_lights()) lit.noise.resize(surfaces.points.size());
  lighting.variance = lit.noise;
  lit.irradiance = irradiance(lighting, held);
  for (std::size_t i = 0; i < lit.noise.size(); ++i) {
    const Rgb albedo(appearances_[rays[surfaces.rays[i]].hit.mesh].albedo);
    lit.noise[i] = lit.noise[i] * albedo * albedo;
  }
  return lit;
}

Shader::Lit Shader::evaluated(const Kind& kind, const Surfaces& surfaces, std::span<const TracedRay> rays,
                              HeldView::Surface* held) const {
  Lit lit;
  const TranslucentGroup& group = *kind.group;
  PointIrradianceInput lighting = lighting_of(surfaces, kind.eta);
  if (needs_irradiance(group)) {
    lit.noise.resize(surfaces.points.size());
    if (has_visible_lights()) lighting.variance = lit.noise;
    lit.irradiance = irradiance(lighting, held);
    lighting.variance = {};
  }
  std::vector<Exitance> exitance =
      group.surface_cache ? interpolated(*group.surface_cache, surfaces, lit, rays)
                          : summed(group, surfaces, lit, held != nullptr ? &held->packets : nullptr);
  for (std::size_t i = 0; i < lit.noise.size(); ++i) {
    const Rgb own(own_part(group.kernel.own_irradiance, exitance[i], RgbF(1)));
    lit.noise[i] = lit.noise[i] * own * own;
  }
  const auto& near_field = near_fields_[std::size_t(&group - input_.groups.data())];
  const bool keeps = held != nullptr && input_.view->keeps_near_field && input_.view->has_room;
  if (near_field) {
    const std::vector<Rgb> noise = lit.noise;
    const std::vector<std::uint32_t> refined = near_field->refine(
        lighting, lit.irradiance, exitance, lit.noise, keeps ? &held->near_field : nullptr);
    if (has_visible_lights() && !refined.empty())
      lit.bias = selection_bias({group.kernel.own_irradiance, lit.irradiance, exitance, noise, refined});
  }
  const bool traced = !lit.irradiance.empty();
  const RgbF& creases = creases_[std::size_t(&group - input_.groups.data())];
  for (std::vector<RgbF>* values : {&lit.exitance, &lit.error, &lit.irradiance})
    values->reserve(exitance.size());
  for (const Exitance& e : exitance) {
    lit.exitance.push_back(e.exitance);
    lit.error.push_back(e.error + e.exitance * creases);
    if (!traced) lit.irradiance.push_back(e.irradiance);
  }
  return lit;
}

std::vector<Exitance> Shader::summed(const TranslucentGroup& group, const Surfaces& surfaces, const Lit& lit,
                                     QueryPackets* packets) const {
  std::vector<Query> queries;
  queries.reserve(surfaces.points.size());
  for (const SurfacePoint& point : surfaces.points) queries.push_back({point.position, point.normal});
  const Settings& settings = input_.scene.settings;
  return evaluate({group.octree, group.kernel, queries, lit.irradiance, settings.evaluator,
                   settings.tolerance, settings.max_solid_angle, settings.instruction_set, group.cloud,
                   nullptr, packets});
}

std::vector<Exitance> Shader::interpolated(const SurfaceCache& cache, const Surfaces& surfaces,
                                           const Lit& lit, std::span<const TracedRay> rays) {
  std::vector<Exitance> exitance(surfaces.rays.size());
  for (std::size_t i = 0; i < exitance.size(); ++i) {
    const Hit& hit = rays[surfaces.rays[i]].hit;
    exitance[i] =
        cache.at(hit.mesh, hit.triangle, hit.u, hit.v, lit.irradiance.empty() ? nullptr : &lit.irradiance[i]);
  }
  return exitance;
}

void Shader::write(const Surfaces& surfaces, const Lit& lit, std::span<const TracedRay> rays,
                   std::span<PixelSample> out) const {
  for (std::size_t i = 0; i < surfaces.rays.size(); ++i) {
    const auto& [ray, hit] = rays[surfaces.rays[i]];
    const Appearance& appearance = appearances_[hit.mesh];
    const SurfacePoint& point = surfaces.points[i];
    PixelSample& sample = out[surfaces.rays[i]];
    const RgbF exitance = lit.exitance.empty() ? appearance.albedo * lit.irradiance[i] : lit.exitance[i];
    const float radiance = radiance_of_exitance(appearance, cos_view(point, ray.direction));
    sample.diffuse = exitance * radiance;
    sample.coverage = 1;
    sample.albedo = appearance.albedo;
    if (!lit.irradiance.empty()) sample.irradiance = lit.irradiance[i];
    if (!lit.error.empty()) sample.error = lit.error[i] * radiance;
    if (!lit.noise.empty()) sample.noise = lit.noise[i] * double(radiance * radiance);
    if (!lit.bias.empty()) sample.bias = lit.bias[i] * radiance;
    sample.translucent = appearance.translucent ? 1.0f : 0.0f;
    sample.normal = point.normal;
    sample.position = Vec3f(out_of_world(input_.world, Vec3d(point.position)));
    sample.depth = float(ray.far * input_.world.unit);
  }
}

// The smooth boundary mirrors area lights and surroundings; a point has no extent to be seen by reflection.
void Shader::add_mirrored_lights(const Surfaces& surfaces, std::span<const TracedRay> rays,
                                 std::span<PixelSample> out) const {
  std::vector<TracedRay> mirrored(surfaces.rays.size());
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    const SurfacePoint& point = surfaces.points[i];
    const Vec3f d = normalized(rays[surfaces.rays[i]].ray.direction);
    const Vec3f r = d - point.normal * (2 * dot(d, point.normal));
    const float side = dot(r, point.geometric) >= 0 ? 1.0f : -1.0f;
    mirrored[i].ray = {point.position + point.geometric * (side * point.offset), r};
  }
  input_.rays.intersect(mirrored);
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    const auto& [ray, hit] = mirrored[i];
    const EmitterHit emitter = nearest_emitter(ray.origin, ray.direction, ray.far);
    const RgbF seen = emitter.hit              ? emitter.radiance
                      : hit.mesh != Hit::kMiss ? RgbF{}
                                               : surroundings(ray.direction);
    const TracedRay& camera = rays[surfaces.rays[i]];
    const float cosine = cos_view(surfaces.points[i], camera.ray.direction);
    out[surfaces.rays[i]].specular = seen * fresnel_reflectance(cosine, appearances_[camera.hit.mesh].eta);
  }
}

EmitterHit Shader::nearest_emitter(const Vec3f& origin, const Vec3f& direction, float far) const {
  EmitterHit nearest;
  for (const Light& light : emitters_) {
    const EmitterHit hit = intersect_emitter(light, origin, direction, nearest.hit ? nearest.t : far);
    if (hit.hit) nearest = hit;
  }
  return nearest;
}

RgbF Shader::surroundings(const Vec3f& direction) const {
  RgbF radiance;
  for (const Light& light : surroundings_) radiance += background(light, direction);
  return radiance;
}

PointIrradianceInput Shader::lighting_of(const Surfaces& surfaces, float eta) const {
  const Settings& settings = input_.scene.settings;
  // The samples of a pixel share the rays: their average has as many.
  const int spp = input_.scene.film.samples_per_pixel,
            light_samples = (settings.light_samples + spp - 1) / spp;
  return {input_.rays,
          surfaces.points,
          surfaces.keys,
          lights_,
          double(eta),
          light_samples,
          point_irradiance_seed(settings)};
}

}  // namespace opaline
