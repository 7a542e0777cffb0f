// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/preintegrated/preintegrated_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "geometry/vertex_curvature.h"
#include "irradiance/sample_key.h"
#include "irradiance/shadow_batch.h"
#include "lights/light.h"
#include "lights/shared_rays.h"
#include "subsurface/body_stages.h"
#include "transport/half_space.h"

namespace opaline {
namespace {

/// All directions of a hemisphere alike: those along the surface count, too.
LightSample sample_hemisphere(const Vec3f& normal, std::array<double, 2> unit_square, int samples) {
  const double cosine = unit_square[0], sine = std::sqrt(1 - cosine * cosine),
               angle = 2 * std::numbers::pi * unit_square[1];
  Vec3f x, y;
  tangent_frame(normal, x, y);
  const Vec3f direction =
      x * float(sine * std::cos(angle)) + y * float(sine * std::sin(angle)) + normal * float(cosine);
  return {direction, std::numeric_limits<float>::infinity(), float(2 * std::numbers::pi / samples)};
}

/// Weight of the body's thickness for light from behind, by the cosine to the normal.
float share_behind(float cosine) {
  constexpr float kFirst = .1f, kLast = .4f;  // cosines below the horizon
  return std::clamp((-cosine - kFirst) / (kLast - kFirst), 0.f, 1.f);
}

template <class Value>
Value at_hit(const Mesh& mesh, std::span<const Value> at_vertices, const Hit& hit) {
  const auto& [a, b, c] = mesh.triangles[hit.triangle];
  return at_vertices[a] * (1 - hit.u - hit.v) + at_vertices[b] * hit.u + at_vertices[c] * hit.v;
}

// Light past the fuzz. At grazing angles and beyond, it enters elsewhere on the body, from many sides.
float past_fuzz(const OuterBoundary& boundary, float cosine) {
  constexpr float kGrazing = .3f;
  if (!boundary.has_fuzz()) return 1;
  const float here = std::clamp(cosine / kGrazing, 0.f, 1.f);
  return boundary.past_fuzz(std::max(cosine, kGrazing)) * here + boundary.past_fuzz() * (1 - here);
}

}  // namespace

MediumResponse make_response(const Medium& medium, const World& world) {
  const DiffuseProfile profile = make_diffuse_profile(medium, world.unit);
  const Rgb absorbed = reduced_absorption(medium);
  constexpr double kHalfOfGaussian = 1.177;  // wave number x deviation: a Gaussian keeps half of the contrast
  RgbF kept, total;
  double inverse_width = 0;
  std::vector<CalibratedMedium> media;
  for (std::size_t c = 0; c < 3; ++c) {
    HomogeneousMedium reduced{.eta = profile.eta};
    if (profile.total[c] > 0) {
      // Without a mean free path, a ball of any size is flat.
      const double length = std::max(profile.mean_free_path[c], 1e-9 * world.diagonal);
      reduced = {absorbed[c] / length, (1 - absorbed[c]) / length, 0, profile.eta};
    }
    const CalibratedMedium& calibrated = media.emplace_back(reduced);
    if (!(reduced.sigma_s > 0)) continue;
    inverse_width += half_contrast(calibrated) / kHalfOfGaussian / 3;
    total[c] = float(HalfSpace(1 - reduced.albedo(), reduced.eta).diffuse_share());
  }
  const double wave_number = 2 * kHalfOfGaussian * inverse_width;  // typical for the blurred details
  for (std::size_t c = 0; c < 3; ++c)
    if (total[c] > 0) kept[c] = float(kept_contrast(media[c], wave_number));
  return {SphereResponse({media[0], media[1], media[2]}), kept, total,
          inverse_width > 0 ? float(1 / inverse_width) : 0};
}

SmoothSurface smoothed(const Mesh& mesh, float width) {
  SmoothSurface smooth;
  if (!(width > 0)) return smooth;
  smooth.normals = blurred_normals(mesh, double(width));
  smooth.curvatures = mean_curvature(mesh, smooth.normals);
  return smooth;
}

PreintegratedField::PreintegratedField(const RenderInput& input, const Body& body)
    : rays_(input.rays),
      world_(input.world),
      medium_(*state_of<PreintegratedState>(body).response.value),
      surfaces_(input.world.meshes.size()),
      boundary_(body.boundary),
      samples_per_pixel_(input.scene.film.samples_per_pixel) {
  const std::vector<SmoothSurface>& surfaces = state_of<PreintegratedState>(body).surfaces.value;
  for (std::size_t m = 0; m < surfaces.size(); ++m) surfaces_[body.plan.meshes[m]] = &surfaces[m];
}

PreintegratedField::Place PreintegratedField::smooth_at(const SurfacePoint& point, const Hit& hit,
                                                        bool is_bent) const {
  const Vec3f unbent =
      is_bent ? rays_.surface_point(hit.mesh, hit.triangle, hit.u, hit.v).normal : point.normal;
  const auto& [normals, curvatures] = *surfaces_[hit.mesh];
  if (normals.empty()) return {unbent, unbent, 0};
  const Mesh& mesh = world_.meshes[hit.mesh];
  return {normalized(at_hit<Vec3f>(mesh, normals, hit)), unbent, at_hit<float>(mesh, curvatures, hit)};
}

// Maps bend normals in light alone: behind the terminator, bumps lie in the body's shadow.
RgbF PreintegratedField::response(const Place& place, const Vec3f& normal, const Vec3f& towards) const {
  constexpr float kLit = .2f;  // cosine of full detail
  const float cosine = dot(normal, towards), smooth = dot(place.normal, towards),
              unbent = dot(place.unbent, towards);
  const SphereResponse& ball = medium_.ball;
  const RgbF curved = ball.at(smooth, place.curvature);
  if (cosine == smooth) return curved;
  const RgbF flat = ball.at(unbent, 0);
  RgbF detail = flat - ball.at(smooth, 0);
  if (cosine != unbent) detail += (ball.at(cosine, 0) - flat) * std::clamp(unbent / kLit, 0.f, 1.f);
  return component_max(RgbF(0), curved + medium_.kept * detail);
}

// Ball with this chord in the direction, by the shading normal; near the horizon, the smooth surface.
PreintegratedField::Place PreintegratedField::through(const Place& place, const Vec3f& towards,
                                                      float thickness) const {
  const float cosine = dot(place.unbent, towards), behind = share_behind(cosine);
  if (!(behind > 0)) return place;
  const float convex = std::max(0.f, place.curvature);
  const float least =
      std::min(.5f * medium_.width, -2 * cosine / std::max(convex, 1e-9f));  // bumps are no body
  return {normalized(place.unbent * behind + place.normal * (1 - behind)), place.unbent,
          behind * -2 * cosine / std::max(thickness, least) + (1 - behind) * convex};
}

// Distance from a hit without own occluders: light spreads around nearer ones, and crosses to the far side of a ball.
float PreintegratedField::first_occluder(const Place& place, const Vec3f& towards, float thickness) const {
  constexpr float kMost = 10;  // widths
  const float chord = -2 * dot(place.normal, towards) / std::max(place.curvature, 1e-9f),
              of_ball = std::min(1.1f * chord, kMost * medium_.width),
              behind = thickness > 0 ? share_behind(dot(place.unbent, towards)) : 0;
  return std::max({thickness * 1.001f, (1 - behind) * of_ball, medium_.width});
}

// Origin of a ray through the body. The position of a hit is up to one offset above the surface.
Vec3f PreintegratedField::below(const SurfacePoint& point) {
  return point.position - point.geometric * (2 * point.offset);
}

// Distance through the body to the entry point of the light.
void PreintegratedField::find_thickness(std::span<const SurfacePoint> points,
                                        std::span<Incident> incident) const {
  std::vector<TracedRay> inside;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < incident.size(); ++i) {
    const SurfacePoint& point = points[incident[i].hit];
    if (!(dot(point.geometric, incident[i].towards) < 0)) continue;
    inside.push_back({Ray(below(point), incident[i].towards), {}});
    numbers.push_back(i);
  }
  rays_.intersect(inside);
  for (std::size_t r = 0; r < inside.size(); ++r)
    if (inside[r].hit.mesh != Hit::kMiss) incident[numbers[r]].thickness = inside[r].ray.far;
}

// Shadow rays; on the far side of a body, from the entry point of the light.
void PreintegratedField::add_unoccluded(std::span<const SurfacePoint> points, std::span<const Place> smooth,
                                        std::span<Incident> incident, LeavingLight& result) const {
  find_thickness(points, incident);
  std::vector<Ray> shadow;
  std::vector<std::size_t> numbers;
  std::vector<RgbF> returned;  // exitance over irradiance across the direction
  shadow.reserve(incident.size());
  numbers.reserve(incident.size());
  returned.reserve(incident.size());
  for (std::size_t i = 0; i < incident.size(); ++i) {
    const auto& [hit, towards, distance, irradiance, thickness] = incident[i];
    const SurfacePoint& point = points[hit];
    const RgbF response_here = response(through(smooth[hit], towards, thickness), point.normal, towards);
    const float near = first_occluder(smooth[hit], towards, thickness) + point.offset;
    if (!(near < distance) || !(max_component(response_here) > 0)) continue;
    const Vec3f from = thickness > 0 ? below(point) : point.position + point.geometric * point.offset;
    shadow.emplace_back(from + towards * near, towards, (distance - near) * .9999f);
    numbers.push_back(i);
    returned.push_back(response_here);
  }
  rays_.occluded(shadow);
  for (std::size_t r = 0; r < shadow.size(); ++r) {
    if (shadow[r].far < 0) continue;
    const Incident& light = incident[numbers[r]];
    const SurfacePoint& point = points[light.hit];
    const float cosine = std::min(1.f, dot(point.normal, light.towards));
    const OuterBoundary boundary = boundary_.at(point);
    result.exitance[light.hit] += returned[r] * light.irradiance * past_fuzz(boundary, cosine);
    if (cosine > 0 && dot(smooth[light.hit].unbent, light.towards) > 0)
      result.irradiance[light.hit] += light.irradiance * (cosine * boundary.transmittance(cosine));
  }
}

void PreintegratedField::add_lights(const PointIrradianceInput& lighting, std::span<const Light> lights,
                                    std::span<const Place> smooth, LeavingLight& result) const {
  constexpr std::size_t kAtOnce = 4096;  // rays
  const Light& light = lights[0];
  const bool is_all_around = !extent(light).center && !extent(light).towards;
  const int sides = is_all_around ? 2 : 1;  // each with its share of the rays
  const int samples = is_delta(light) ? 1 : std::max(1, lighting.light_samples / sides);
  const std::uint64_t seed = light_seed(lighting.seed, light);
  std::vector<Incident> incident;
  const auto finish = [&] {
    add_unoccluded(lighting.points, smooth, incident, result);
    incident.clear();
  };
  for (std::size_t i = 0; i < lighting.points.size(); ++i) {
    const auto [index, part] = part_of(lighting.keys[i]);
    const std::array<double, 2> shift{unit_double(hash_bits(seed, 2 * index)),
                                      unit_double(hash_bits(seed, 2 * index + 1))};
    for (int s = 0; s < samples * sides; ++s) {
      const Vec3f about = s % sides == 0 ? smooth[i].normal : -smooth[i].normal;
      const std::array<double, 2> square =
          r2_point(part * std::uint64_t(samples) + std::uint64_t(s / sides), shift);
      std::array<float, 3> weights{};
      LightSample sample;
      if (std::holds_alternative<Surroundings>(light.source)) {
        sample = sample_hemisphere(about, square, samples);
        weights[0] = sample.weight;
      } else {
        sample = sample_lights(lights, lighting.points[i].position, about, square, samples, weights);
      }
      if (!(std::ranges::max(weights) > 0) || (sides == 2 && !(dot(about, sample.direction) > 0))) continue;
      RgbF irradiance;
      for (std::size_t l = 0; l < lights.size(); ++l) irradiance += RgbF(emission(lights[l])) * weights[l];
      incident.push_back({std::uint32_t(i), sample.direction, sample.distance, irradiance});
    }
    if (incident.size() >= kAtOnce) finish();
  }
  finish();
}

LeavingLight PreintegratedField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                                    HeldView::Surface*) const {
  const std::size_t count = hits.points.size();
  std::vector<Place> smooth;
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_bent = !hits.textures.empty() && hits.textures[i].is_bent;
    smooth.push_back(smooth_at(hits.points[i], hits.hits[i], is_bent));
    keys.push_back(key_in_pixel(lighting.keys[i], std::uint64_t(pass.is_seen ? samples_per_pixel_ : 1)));
  }
  lighting.keys = keys;
  LeavingLight light;
  light.exitance.resize(count);
  light.irradiance.resize(count);
  for (std::size_t l = 0, together = 0; l < lighting.lights.size(); l += together) {
    together = sharing_rays(lighting.lights.subspan(l));
    add_lights(lighting, lighting.lights.subspan(l, together), smooth, light);
  }
  for (std::size_t i = 0; i < lighting.bounced.size(); ++i) {
    light.exitance[i] += medium_.total * lighting.bounced[i];
    light.irradiance[i] += lighting.bounced[i];
  }
  for (std::size_t i = 0; i < hits.textures.size(); ++i) {
    const RgbF& tint = hits.textures[i].tint.entering;
    light.exitance[i] = light.exitance[i] * tint;
    light.irradiance[i] = light.irradiance[i] * tint;
  }
  return light;
}

}  // namespace opaline
