// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/shade.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bodies/surface_boundaries.h"
#include "core/random.h"
#include "lights/light_tree.h"
#include "lights/shape_light.h"
#include "render/bounced_light.h"
#include "render/camera_rays.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

/// Bends the shading normal back until the camera direction reflects to the outside of the surface.
/// in    direction: of the camera ray at the point, of any length
void keep_mirrored_outside(SurfacePoint& point, const Vec3f& direction) {
  constexpr float kLeastCosine = 0.01f;  // least cosine of the reflected direction with the geometric normal
  const Vec3f d = normalized(direction), mirrored = d - point.normal * (2 * dot(d, point.normal));
  const float cosine = dot(mirrored, point.geometric);
  if (cosine >= kLeastCosine || !(dot(d, point.geometric) < 0)) return;
  point.normal = normalized(normalized(mirrored + point.geometric * (kLeastCosine - cosine)) - d);
}

/// AngularExit, applied to the subsurface fraction of the exitance.
RgbF scattered_exit(const AngularExit& exit, float cosine, const SurfaceHits& hits, const LeavingLight& light,
                    std::size_t i) {
  RgbF factor = exit.at(cosine);
  if (!light.is_tinted) return factor;
  const RgbF reflected = hits.textures[i].reflected * light.irradiance[i];
  for (std::size_t c = 0; c < 3; ++c)
    if (light.exitance[i][c] > 0)
      factor[c] = 1 + (factor[c] - 1) * std::max(0.f, 1 - reflected[c] / light.exitance[i][c]);
  return factor;
}

// Spread of the cones around some 64 directions over a hemisphere, for texture filtering.
constexpr float kGatheringSpread = 0.25f;

constexpr std::uint64_t kGatheringSeed = 1, kFurtherSeed = 2;

// Width of a camera ray: several share a pixel.
PixelWidth camera_ray_width(const RenderInput& input, int rays_per_pixel) {
  const PixelWidth pixel = pixel_width(input.scene.camera, input.scene.film, input.world);
  const double rays = std::sqrt(rays_per_pixel / input.scene.film.pixel_aspect);
  return {pixel.at_camera / rays, pixel.per_depth / rays};
}

SurfacePoint point_of(const Hit& hit, const RayScene& rays) {
  return rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
}

// Surface points of the rays with a hit.
std::vector<SurfacePoint> points_of(std::span<const TracedRay> traced, const RayScene& rays) {
  std::vector<SurfacePoint> points;
  for (const auto& [ray, hit] : traced)
    if (hit.mesh != Hit::kMiss) points.push_back(point_of(hit, rays));
  return points;
}

}  // namespace

Shader::Shader(const RenderInput& input, std::span<const FieldSource> sources)
    : input_(input),
      lights_(recentred_lights(input.scene, input.world)),
      textures_(input.scene, input.world),
      ray_width_(camera_ray_width(input, input.scene.film.samples_per_pixel)) {
  const std::vector<OuterBoundary> outer = boundaries_of(input.scene, input.world);
  fields_ = make_fields(input, textures_, outer, sources);
  if (input.view != nullptr) {
    std::vector<OuterBoundary> boundaries;
    for (const std::unique_ptr<Field>& field : fields_.all) boundaries.push_back(field->boundary());
    input.view->set_fields(fields_.of_mesh, boundaries);
  }
  for (const Light& light : lights_) emitted_.emplace_back(emission(light));
  const auto add_emission = [&](const Light& light) {
    const auto& of_shape = std::get<ShapeLight>(light.source);
    emitted_by_.resize(input.scene.shapes.size());
    emitted_by_[of_shape.shape].push_back(of_shape);
  };
  for (const Light& light : lights_)
    if (const auto* many = std::get_if<ManyLights>(&light.source); many != nullptr && is_of_shape(light)) {
      if (many->channel.value_or(0) == 0) std::ranges::for_each(many->tree->lights(), add_emission);
    } else if (is_of_shape(light)) {
      add_emission(light);
    } else if (is_visible(light)) {
      met_.add(light);
      if (light.is_seen) seen_.add(light);
    }
  if (input.scene.backdrop) {
    seen_.surroundings.clear();
    seen_.backdrop = RgbF(*input.scene.backdrop);
  }
  std::vector<bool> follows_light(input.scene.shapes.size());
  if (method_of(input.scene.settings.method).needs_bodies())  // else bodies are left from another method
    for (const Body& body : input.groups)
      for (const std::uint32_t mesh : body.plan.meshes)
        follows_light[mesh] = method_of(body.plan.method).follows_textures_inside(true);
  std::map<std::array<std::size_t, 3>, std::size_t> of_medium;  // the first shape
  for (std::size_t i = 0; i < input.scene.shapes.size(); ++i) {
    const Shape& shape = input.scene.shapes[i];
    const auto known =
        shape.medium
            ? of_medium.try_emplace({*shape.medium, follows_light[i], shape.normal_map.has_value()}, i).first
            : of_medium.end();
    appearances_.push_back(known != of_medium.end() && known->second < i
                               ? appearances_[known->second]
                               : mesh_appearance(input.scene, shape, outer[i], follows_light[i]));
  }
  light_samples_ = light_samples_of_ray(input.scene);
  if (input.view != nullptr && can_hold_coats())
    for (const Light& light : lights_) unit_lights_.push_back(with_emission(light, {1, 1, 1}));
}

void Shader::set_ray_width(int rays_per_pixel) {
  ray_width_ = camera_ray_width(input_, rays_per_pixel);
}

Shader::Shaded Shader::shade(const RayBatch& batch, const Pass& pass, HeldView::Batch* held) const {
  if (held != nullptr) held->surfaces.resize(fields_.all.size());
  // Gathered rays are many, so only their lights are cached.
  SurfaceHits catchers;
  Shaded result{collect(batch, pass.is_seen ? held : nullptr, catchers), 0};
  if (!catchers.points.empty()) add_shadows(catchers, batch);
  for (std::size_t f = 0; f < fields_.all.size(); ++f) {
    const SurfaceHits& hits = result.hits[f];
    if (hits.points.empty()) continue;
    const Field& field = *fields_.all[f];
    const OuterBoundary boundary = field.boundary();
    HeldView::Surface* const known = held != nullptr ? &held->surfaces[f] : nullptr;
    const bool is_asked = pass.is_seen ? field.asks_irradiance() : field.reflects();
    const bool shows_fuzz = boundary.has_fuzz() && batch.specular != Specular::uniform;
    const std::vector<RgbF> arriving =
        is_asked || shows_fuzz ? bounced_at(hits, boundary, pass, known) : std::vector<RgbF>{};
    const std::span<const RgbF> bounced = is_asked ? std::span(arriving) : std::span<const RgbF>{};
    const PointIrradianceInput lighting{input_.rays,
                                        hits.points,
                                        hits.keys,
                                        lights_,
                                        boundary,
                                        batch.light_samples,
                                        point_irradiance_seed(input_.scene.settings),
                                        {},
                                        bounced,
                                        pass.is_seen && batch.mirrors == 0};
    write(hits, field.at(hits, lighting, pass, known), batch.rays, batch.out);
    if (!batch.bounced_further.empty() && !bounced.empty()) write_further(hits, bounced, batch);
    if (field.asks_samples()) result.queries += hits.points.size();
    if (shows_fuzz) add_fuzz(hits, boundary, arriving, batch);
    if (batch.specular == Specular::uniform) {
      add_evenly_mirrored(hits, batch);
      if (mirrored_by_bodies_ == MirroredByBodies::of_surfaces) add_mirrored_surfaces(hits, batch);
    }
    if (batch.specular == Specular::traced && boundary.eta() > 0 && boundary.eta() != 1)
      add_specular(hits, batch, pass, known);
  }
  return result;
}

std::vector<RgbF> Shader::bounced_at(const SurfaceHits& hits, const OuterBoundary& boundary, const Pass& pass,
                                     HeldView::Surface* held) const {
  if (!pass.is_seen) return bounced_further(hits, boundary, held);
  if (bounced_ != nullptr) return bounced_->at(hits, boundary, held);
  if (pass.gathers == nullptr) return {};
  return gathered_irradiance({input_.rays, *pass.gathers, hits.points, hits.keys, boundary, 1,
                              hash_bits(point_irradiance_seed(input_.scene.settings), kGatheringSeed)});
}

std::vector<RgbF> Shader::bounced_further(const SurfaceHits& hits, const OuterBoundary& boundary,
                                          HeldView::Surface* held) const {
  constexpr float kMostLikely = .9f;  // probability to continue a path; ends it in white rooms
  std::vector<RgbF> irradiance(hits.points.size());
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> chosen;
  std::vector<float> probability;
  for (std::uint32_t i = 0; i < hits.points.size(); ++i) {
    const Appearance& plain = appearances_[hits.hits[i].mesh];
    const RgbF albedo = hits.textures.empty() ? plain.albedo : appearance_of(hits, i).albedo;
    const float of_fuzz = max_component(plain.fuzz_color) * (1 - boundary.past_fuzz());
    const float likely = std::min(kMostLikely, std::max(max_component(albedo), of_fuzz));
    const std::uint64_t key = hash_bits(hits.keys[i], kFurtherSeed);
    if (!(float(unit_double(key)) < likely)) continue;
    points.push_back(hits.points[i]);
    keys.push_back(hash_bits(key, 1));
    chosen.push_back(i);
    probability.push_back(likely);
  }
  if (chosen.empty()) return irradiance;
  const bool is_kept = held != nullptr && input_.view->keeps_further_bounces;
  const std::vector<RgbF> gathered =
      gathered_irradiance({input_.rays, *this, points, keys, boundary, 1,
                           hash_bits(point_irradiance_seed(input_.scene.settings), kFurtherSeed),
                           is_kept ? &gathering_of(held->gathering, chosen) : nullptr, input_.view});
  for (std::size_t k = 0; k < chosen.size(); ++k) irradiance[chosen[k]] = gathered[k] * (1 / probability[k]);
  return irradiance;
}

std::vector<RgbF> Shader::radiance_along(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                                         HeldView::Batch* held, std::span<RgbF> further) const {
  std::vector<PixelSample> seen(rays.size());
  shade({.rays = rays,
         .keys = keys,
         .out = seen,
         .spread = kGatheringSpread,
         .specular = Specular::uniform,
         .bounced_further = further},
        {.entry_samples = 1, .is_seen = false}, held);
  std::vector<RgbF> radiance;
  radiance.reserve(seen.size());
  for (const PixelSample& sample : seen) radiance.push_back(sample.diffuse + sample.specular);
  return radiance;
}

// The part of the irradiance at the hits.
void Shader::write_further(const SurfaceHits& hits, std::span<const RgbF> bounced, const RayBatch& batch) {
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const PixelSample& sample = batch.out[hits.rays[i]];
    const RgbF arriving = hits.textures.empty() ? bounced[i] : bounced[i] * hits.textures[i].tint.entering;
    for (std::size_t c = 0; c < 3; ++c)
      if (sample.irradiance[c] > 0)
        batch.bounced_further[hits.rays[i]][c] =
            sample.diffuse[c] * std::min(1.f, arriving[c] / sample.irradiance[c]);
  }
}

std::vector<Shader::SeenSurfaces> Shader::surfaces_along(std::span<const TracedRay> rays,
                                                         std::span<const std::uint64_t> keys) const {
  std::vector<PixelSample> lights(rays.size());
  SurfaceHits catchers;
  std::vector<SurfaceHits> hits = collect({.rays = rays,
                                           .keys = keys,
                                           .out = lights,
                                           .spread = float(ray_width_.per_depth),
                                           .width = float(ray_width_.at_camera),
                                           .is_of_camera = true},
                                          nullptr, catchers);
  std::vector<SeenSurfaces> seen;
  for (std::size_t f = 0; f < hits.size(); ++f)
    if (!hits[f].points.empty() &&
        (fields_.all[f]->asks_irradiance() || fields_.all[f]->boundary().has_fuzz()))
      seen.push_back({f, std::move(hits[f]), fields_.all[f]->boundary()});
  return seen;
}

// Sorts the hits by field; rays meeting a light or nothing are done.
std::vector<SurfaceHits> Shader::collect(const RayBatch& batch, HeldView::Batch* held,
                                         SurfaceHits& catchers) const {
  const std::span<const TracedRay> rays = batch.rays;
  const std::span<const std::uint64_t> keys = batch.keys;
  const std::span<PixelSample> out = batch.out;
  std::vector<SurfaceHits> surfaces(fields_.all.size());
  const bool holds_points = held != nullptr && input_.view->has_room;
  if (holds_points && held->points.empty()) held->points = points_of(rays, input_.rays);
  const MetLights& lights = batch.is_of_camera ? seen_ : met_;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [ray, hit] = rays[i];
    if (hit.mesh != Hit::kMiss) ++hits;
    const EmitterHit emitter = lights.nearest(ray.origin, ray.direction, ray.far);
    if (emitter.hit) {
      out[i].emitted = emitter.radiance;
    } else if (hit.mesh == Hit::kMiss) {
      out[i].emitted = lights.radiance(ray.direction);
    } else {
      const bool is_caught = batch.is_of_camera && input_.scene.shapes[hit.mesh].catches_shadows;
      SurfaceHits& own = is_caught ? catchers : surfaces[fields_.of_mesh[hit.mesh]];
      if (own.points.empty()) {
        own.points.reserve(rays.size());
        own.hits.reserve(rays.size());
        own.keys.reserve(rays.size());
        own.rays.reserve(rays.size());
      }
      SurfacePoint point = holds_points ? held->points[hits - 1] : point_of(hit, input_.rays);
      // An opaque sheet has two equal sides; a translucent one is lit and seen from outside. A moving one shows the side
      // turned to the ray at the time of the ray.
      const bool may_move = !input_.scene.shutter.empty();
      const Vec3f& outwards = may_move ? hit.edges_cross : point.geometric;
      const bool is_front = dot(outwards, ray.direction) < 0;
      const bool from_behind = !appearances_[hit.mesh].translucent && dot(outwards, ray.direction) > 0;
      if (from_behind) {
        point.geometric = -point.geometric;
        point.normal = -point.normal;
      }
      // Back along the ray: on an edge, the normal alone would lead rays into the other face's plane.
      if (may_move && dot(point.geometric, ray.direction) > 0)
        point.position += point.geometric * point.offset;
      else
        point.position -= normalized(ray.direction) * point.offset;
      if (!emitted_by_.empty() && !is_caught && is_front) out[i].emitted = emitted_towards(batch, i, point);
      if (!textures_.empty()) add_textures(batch, i, from_behind, point, own);
      own.points.push_back(point);
      own.hits.push_back(hit);
      own.keys.push_back(keys[i]);
      own.rays.push_back(std::uint32_t(i));
    }
  }
  return surfaces;
}

void Shader::add_textures(const RayBatch& batch, std::size_t ray, bool from_behind, SurfacePoint& point,
                          SurfaceHits& hits) const {
  const auto& [traced, hit] = batch.rays[ray];
  point.width = width_at(batch, ray);
  SurfaceTextures::Place place = textures_.place(hit.mesh, hit.triangle, hit.u, hit.v,
                                                 footprint_of(point, traced.direction, point.width));
  place.from_behind = from_behind;
  const Vec3f unbent = point.normal;
  const float slope_variance = textures_.bend(place, point);
  const bool is_bent = point.normal != unbent;
  if (is_bent) keep_mirrored_outside(point, traced.direction);
  HitTextures here{textures_.tint(place), textures_.reflected(place)};
  appearances_[hit.mesh].look_up(place, point, here);
  here.slope_variance = slope_variance;
  here.is_bent = is_bent;
  here.grain = textures_.grain(place, point);
  if (here.grain.tangent != Vec3f{}) {
    const float along = dot(traced.direction, here.grain.tangent),
                across = dot(traced.direction, cross(point.normal, here.grain.tangent));
    const float both = along * along + across * across;
    if (both > 0) here.tangent_share = along * along / both;
  }
  hits.textures.push_back(here);
}

RgbF Shader::emitted_towards(const RayBatch& batch, std::size_t ray, const SurfacePoint& point) const {
  const auto& [traced, hit] = batch.rays[ray];
  RgbF sum;
  for (const ShapeLight& light : emitted_by_[hit.mesh]) {
    const Footprint around = footprint_of(point, traced.direction, width_at(batch, ray));
    sum += RgbF(in_channel(light.radiance, light.channel)) *
           light.surface->texel({hit.triangle, hit.u, hit.v}, {around.x, around.y});
  }
  return sum;
}

float Shader::width_at(const RayBatch& batch, std::size_t ray) const {
  return (batch.widths.empty() ? batch.width : batch.widths[ray]) + batch.spread * batch.rays[ray].ray.far;
}

Appearance Shader::appearance_of(const SurfaceHits& hits, std::size_t i) const {
  return appearances_[hits.hits[i].mesh].at(hits.textures[i]);
}

void Shader::write(const SurfaceHits& hits, const LeavingLight& light, std::span<const TracedRay> rays,
                   std::span<PixelSample> out) const {
  for (std::size_t i = 0; i < hits.rays.size(); ++i) {
    const auto& [ray, hit] = rays[hits.rays[i]];
    const bool is_plain = hits.textures.empty();
    const Appearance textured = is_plain ? Appearance{} : appearance_of(hits, i);
    const Appearance& appearance = is_plain ? appearances_[hit.mesh] : textured;
    const SurfacePoint& point = hits.points[i];
    PixelSample& sample = out[hits.rays[i]];
    const float cosine = cos_view(point, ray.direction);
    RgbF radiance = appearance.boundary.has_fuzz() ? appearance.radiance_past_fuzz(cosine)
                                                   : RgbF(appearance.radiance_of_exitance(cosine));
    if (!is_plain && !light.is_tinted) radiance = radiance * hits.textures[i].tint.leaving;
    if (appearance.exit) radiance = radiance * scattered_exit(*appearance.exit, cosine, hits, light, i);
    sample.diffuse = light.exitance[i] * radiance;
    sample.coverage = 1;
    sample.albedo = appearance.albedo;
    if (!light.irradiance.empty()) sample.irradiance = light.irradiance[i];
    if (!light.error.empty()) sample.error = light.error[i] * radiance;
    if (!light.noise.empty()) sample.noise = light.noise[i] * Rgb(radiance * radiance);
    if (!light.bias.empty()) sample.bias = light.bias[i] * radiance;
    sample.translucent = appearance.translucent ? 1.0f : 0.0f;
    sample.normal = point.normal;
    sample.position = Vec3f(out_of_world(input_.world, Vec3d(point.position)));
    sample.depth = float(ray.far * input_.world.unit);
  }
}

void Shader::add_shadows(const SurfaceHits& catchers, const RayBatch& batch) const {
  std::vector<RgbF> unshadowed(catchers.points.size());
  PointIrradianceInput lighting{input_.rays, catchers.points, catchers.keys, lights_};
  lighting.light_samples = batch.light_samples;
  lighting.seed = point_irradiance_seed(input_.scene.settings);
  lighting.unshadowed = unshadowed;
  const std::vector<RgbF> shadowed = irradiance_at(lighting);
  for (std::size_t i = 0; i < catchers.rays.size(); ++i) {
    RgbF lit(1);  // share of the light; estimates of an environment may leave 0 to 1
    for (std::size_t c = 0; c < 3; ++c)
      if (unshadowed[i][c] > 0) lit[c] = std::clamp(shadowed[i][c] / unshadowed[i][c], 0.f, 1.f);
    PixelSample& sample = batch.out[catchers.rays[i]];
    sample.emitted = seen_.radiance(batch.rays[catchers.rays[i]].ray.direction) * lit;
    sample.shadow = 1 - (lit.x + lit.y + lit.z) / 3;
  }
}

void Shader::MetLights::add(const Light& light) {
  (extent(light).center ? emitters : surroundings).push_back(light);
}

EmitterHit Shader::MetLights::nearest(const Vec3f& origin, const Vec3f& direction, float far) const {
  EmitterHit nearest;
  for (const Light& light : emitters) {
    const EmitterHit hit = intersect_emitter(light, origin, direction, nearest.hit ? nearest.t : far);
    if (hit.hit) nearest = hit;
  }
  return nearest;
}

RgbF Shader::MetLights::radiance(const Vec3f& direction) const {
  RgbF radiance = backdrop;
  for (const Light& light : surroundings) radiance += background(light, direction);
  return radiance;
}

}  // namespace opaline
