// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/shade.h"

#include <algorithm>
#include <numbers>

#include "opaline/core/random.h"
#include "opaline/diffusion/fresnel.h"
#include "opaline/irradiance/light_sampling.h"

namespace opaline {
namespace {

constexpr float kInversePi = float(std::numbers::inv_pi);

Appearance appearance_of(const RenderInput& input, std::size_t mesh) {
  const Shape& shape = input.scene.shapes[mesh];
  Appearance appearance;
  appearance.albedo = RgbF(shape.reflectance);
  if (!shape.medium) return appearance;
  const DiffuseProfile profile = make_diffuse_profile(input.scene.media[*shape.medium]);
  appearance = {true, RgbF(profile.total), float(profile.eta), float(profile.average_reflectance), nullptr};
  if (input.scene.settings.method == Method::lambert) return appearance;
  for (const TranslucentGroup& group : input.groups)
    if (std::ranges::find(group.plan.meshes, mesh) != group.plan.meshes.end()) appearance.group = &group;
  return appearance;
}

// Radiance in the view direction of a surface that sends out `exitance`.
RgbF outgoing_radiance(const Appearance& a, const RgbF& exitance, float cos_view) {
  if (!a.translucent) return exitance * kInversePi;
  return exitance * (kInversePi * fresnel_transmittance(cos_view, a.eta) / (1 - a.average_reflectance));
}

}  // namespace

Shader::Shader(const RenderInput& input) : input_(input) {
  for (const Light& light : input.scene.lights) {
    lights_.push_back(recentred(light, input.world.origin));
    if (const auto* all_around = std::get_if<Surroundings>(&light.source))
      surroundings_ += RgbF(all_around->radiance);
    else if (!is_delta(light))
      emitters_.push_back(lights_.back());
  }
  for (std::size_t m = 0; m < input.world.meshes.size(); ++m) appearances_.push_back(appearance_of(input, m));
}

std::size_t Shader::shade(std::span<const Ray> rays, std::span<const Hit> hits,
                          std::span<const std::uint64_t> keys, std::span<PixelSample> out) const {
  std::vector<Surface> surfaces;
  const auto hit_count = std::ranges::count_if(hits, [](const Hit& h) { return h.mesh != Hit::kMiss; });
  if (hit_count == 0 && emitters_.empty() && surroundings_ == RgbF{}) return 0;
  surfaces.reserve(std::size_t(hit_count));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = hits[i].mesh != Hit::kMiss;
    const float far = hit ? hits[i].t : rays[i].far;
    const EmitterHit emitter = nearest_emitter(rays[i].origin, rays[i].direction, far);
    if (emitter.hit)
      out[i].emitted = emitter.radiance;
    else if (hit)
      surfaces.push_back(surface_at(i, rays[i], hits[i]));
    else
      out[i].emitted = surroundings_;
  }
  const std::size_t queries = add_translucent(surfaces, keys, out);
  add_lambert(surfaces, keys, out);
  add_mirrored_lights(surfaces, rays, out);
  for (const Surface& s : surfaces) {
    PixelSample& sample = out[s.ray];
    sample.diffuse = outgoing_radiance(*s.appearance, s.exitance, s.cos_view);
    sample.coverage = 1;
    sample.albedo = s.appearance->albedo;
    sample.normal = s.point.normal;
    sample.position = Vec3f(Vec3d(s.point.position) + input_.world.origin);
    sample.depth = hits[s.ray].t;
  }
  return queries;
}

Shader::Surface Shader::surface_at(std::size_t ray, const Ray& camera_ray, const Hit& hit) const {
  const Appearance& appearance = appearances_[hit.mesh];
  Surface s{
      ray, surface_point(input_.world.meshes[hit.mesh], hit.triangle, hit.u, hit.v), &appearance, 0, {}};
  s.point.offset = input_.rays.offset(hit.mesh, s.point.position);
  const Vec3f view = normalized(-camera_ray.direction);
  // An opaque sheet has two equal sides; a translucent one is lit and seen from outside.
  if (!appearance.translucent && dot(s.point.geometric, view) < 0) {
    s.point.geometric = -s.point.geometric;
    s.point.normal = -s.point.normal;
  }
  s.cos_view = std::min(1.0f, std::abs(dot(s.point.normal, view)));
  return s;
}

// Surfaces whose exitance is local: opaque ones, and translucent ones without a tree.
void Shader::add_lambert(std::vector<Surface>& surfaces, std::span<const std::uint64_t> keys,
                         std::span<PixelSample> out) const {
  std::vector<Surface*> rest;
  for (Surface& s : surfaces)
    if (s.appearance->group == nullptr) rest.push_back(&s);
  // One batch of shadow rays for each kind of boundary.
  while (!rest.empty()) {
    const float eta = rest.front()->appearance->translucent ? rest.front()->appearance->eta : 0;
    const auto same = [eta](const Surface* s) {
      return (s->appearance->translucent ? s->appearance->eta : 0) == eta;
    };
    const auto end = std::stable_partition(rest.begin(), rest.end(), same);
    const std::vector<const Surface*> batch(rest.begin(), end);
    const std::vector<RgbF> entered = irradiance(batch, keys, double(eta));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      rest[i]->exitance = rest[i]->appearance->albedo * entered[i];
      out[rest[i]->ray].irradiance = entered[i];
    }
    rest.erase(rest.begin(), end);
  }
}

std::size_t Shader::add_translucent(std::vector<Surface>& surfaces, std::span<const std::uint64_t> keys,
                                    std::span<PixelSample> out) const {
  std::size_t queries = 0;
  for (const TranslucentGroup& group : input_.groups) {
    std::vector<Surface*> own;
    for (Surface& s : surfaces)
      if (s.appearance->group == &group) own.push_back(&s);
    if (own.empty()) continue;
    std::vector<Query> points;
    for (const Surface* s : own) points.push_back({s->point.position, s->point.normal});
    std::vector<RgbF> at_point;
    if (group.kernel.needs_irradiance())
      at_point = irradiance({own.begin(), own.end()}, keys, group.profile.eta);
    const Settings& settings = input_.scene.settings;
    const std::vector<Exitance> exitance = evaluate(
        {group.octree, group.kernel, points, at_point, settings.evaluator, settings.max_solid_angle});
    for (std::size_t i = 0; i < own.size(); ++i) {
      own[i]->exitance = exitance[i].exitance;
      out[own[i]->ray].irradiance = at_point.empty() ? exitance[i].irradiance : at_point[i];
    }
    queries += own.size();
  }
  return queries;
}

// The smooth boundary mirrors area lights and surroundings; a point has no extent to be seen by reflection.
void Shader::add_mirrored_lights(const std::vector<Surface>& surfaces, std::span<const Ray> rays,
                                 std::span<PixelSample> out) const {
  if (emitters_.empty() && surroundings_ == RgbF{}) return;
  std::vector<Ray> mirrored;
  std::vector<const Surface*> owners;
  for (const Surface& s : surfaces) {
    if (!s.appearance->translucent) continue;
    const Vec3f d = normalized(rays[s.ray].direction);
    const Vec3f r = d - s.point.normal * (2 * dot(d, s.point.normal));
    const float side = dot(r, s.point.geometric) >= 0 ? 1.0f : -1.0f;
    mirrored.push_back({s.point.position + s.point.geometric * (side * s.point.offset), r});
    owners.push_back(&s);
  }
  std::vector<Hit> hits(mirrored.size());
  input_.rays.intersect(mirrored, hits);
  for (std::size_t i = 0; i < mirrored.size(); ++i) {
    const bool blocked = hits[i].mesh != Hit::kMiss;
    const EmitterHit emitter =
        nearest_emitter(mirrored[i].origin, mirrored[i].direction, blocked ? hits[i].t : mirrored[i].far);
    const RgbF seen = emitter.hit ? emitter.radiance : blocked ? RgbF{} : surroundings_;
    out[owners[i]->ray].specular =
        seen * fresnel_reflectance(owners[i]->cos_view, owners[i]->appearance->eta);
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

std::vector<RgbF> Shader::irradiance(const std::vector<const Surface*>& surfaces,
                                     std::span<const std::uint64_t> keys, double eta) const {
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> point_keys;
  for (const Surface* s : surfaces) {
    points.push_back(s->point);
    point_keys.push_back(keys[s->ray]);
  }
  const Settings& settings = input_.scene.settings;
  // The samples of a pixel share the rays: their average has as many.
  const int spp = input_.scene.film.samples_per_pixel,
            light_samples = (settings.light_samples + spp - 1) / spp;
  return irradiance_at(
      {input_.rays, points, point_keys, lights_, eta, light_samples, hash_bits(settings.seed, 2000)});
}

}  // namespace opaline
