// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/preintegrated/preintegrated_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bodies/body.h"
#include "core/random.h"
#include "geometry/vertex_curvature.h"
#include "irradiance/sample_key.h"
#include "irradiance/shadow_batch.h"
#include "lights/light.h"
#include "lights/shared_rays.h"
#include "transport/fresnel.h"
#include "transport/half_space.h"

namespace opaline {
namespace {

/// Unoccluded light of one shadow ray.
struct Arriving {
  std::uint32_t hit;
  float cosine;     // to the normal
  RgbF irradiance;  // across the direction
  RgbF returned;    // exitance over it
};

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

template <class Value>
Value at_hit(const Mesh& mesh, std::span<const Value> at_vertices, const Hit& hit) {
  const auto& [a, b, c] = mesh.triangles[hit.triangle];
  return at_vertices[a] * (1 - hit.u - hit.v) + at_vertices[b] * hit.u + at_vertices[c] * hit.v;
}

}  // namespace

PreintegratedField::PreintegratedField(const RenderInput& input, std::size_t medium)
    : rays_(input.rays),
      smooth_(input.world.meshes.size()),
      world_(input.world),
      eta_(float(input.scene.media[medium].eta)),
      samples_per_pixel_(input.scene.film.samples_per_pixel) {
  const Medium& own = input.scene.media[medium];
  const DiffuseProfile profile = make_diffuse_profile(own, input.world.unit);
  const Rgb absorbed = reduced_absorption(own);
  constexpr double kHalfOfGaussian = 1.177;  // wave number x deviation: a Gaussian keeps half of the contrast
  double inverse_width = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    HomogeneousMedium reduced{.eta = profile.eta};
    if (profile.total[c] > 0) {
      // Without a mean free path, a ball of any size is flat.
      const double length = std::max(profile.mean_free_path[c], 1e-9 * input.world.diagonal);
      reduced = {absorbed[c] / length, (1 - absorbed[c]) / length, 0, profile.eta};
    }
    const CalibratedMedium calibrated(reduced);
    channels_.emplace_back(calibrated);
    if (!(reduced.sigma_s > 0)) continue;
    const double half = half_contrast(calibrated);
    inverse_width += half / kHalfOfGaussian / 3;
    kept_[c] = float(kept_contrast(calibrated, 2 * half));
    total_[c] = float(HalfSpace(1 - reduced.albedo(), reduced.eta).diffuse_share());
  }
  if (!(inverse_width > 0)) return;
  nearest_ = float(1 / inverse_width);
  for (std::size_t m = 0; m < smooth_.size(); ++m) {
    if (input.scene.shapes[m].medium != medium) continue;
    const Mesh& mesh = input.world.meshes[m];
    smooth_[m].normals = blurred_normals(mesh, 1 / inverse_width);
    smooth_[m].curvatures = mean_curvature(mesh, smooth_[m].normals);
  }
}

PreintegratedField::Place PreintegratedField::smooth_at(const SurfacePoint& point, const Hit& hit) const {
  const auto& [normals, curvatures] = smooth_[hit.mesh];
  if (normals.empty()) return {point.normal, 0};
  const Mesh& mesh = world_.meshes[hit.mesh];
  return {normalized(at_hit<Vec3f>(mesh, normals, hit)), at_hit<float>(mesh, curvatures, hit)};
}

RgbF PreintegratedField::response(const Place& place, const Vec3f& normal, const Vec3f& towards) const {
  const float cosine = dot(normal, towards), smooth = dot(place.normal, towards);
  RgbF response;
  for (std::size_t c = 0; c < 3; ++c) {
    const SphereResponse& channel = channels_[c];
    const float detail = cosine == smooth ? 0 : channel.at(cosine, 0) - channel.at(smooth, 0);
    response[c] = std::max(0.f, channel.at(smooth, place.curvature) + kept_[c] * detail);
  }
  return response;
}

// Distance through the body to the entry point of the light.
float PreintegratedField::thickness_along(const SurfacePoint& point, const Vec3f& towards) const {
  TracedRay inside{Ray(point.position - point.geometric * point.offset, towards), {}};
  rays_.intersect_one(inside);
  return inside.hit.mesh == Hit::kMiss ? 0 : inside.ray.far;
}

// Curvature of the ball with this chord in the direction; near the horizon, of the surface.
float PreintegratedField::curvature_through(float cosine, float curvature, float thickness) const {
  constexpr float kFirst = .1f, kLast = .4f;  // cosines below the horizon
  const float convex = std::max(0.f, curvature);
  const float share = std::clamp((-cosine - kFirst) / (kLast - kFirst), 0.f, 1.f);
  if (!(share > 0)) return convex;
  const float least = std::min(.5f * nearest_, -2 * cosine / std::max(convex, 1e-9f));  // bumps are no body
  return share * -2 * cosine / std::max(thickness, least) + (1 - share) * convex;
}

// Shadow rays from all hits; on the far side of a body, from the entry point of the light.
void PreintegratedField::add_lights(const PointIrradianceInput& lighting, std::span<const Light> lights,
                                    std::span<const Place> smooth, LeavingLight& result) const {
  constexpr std::size_t kAtOnce = 4096;  // rays
  const Light& light = lights[0];
  const bool is_all_around = !extent(light).center && !extent(light).towards;
  const int sides = is_all_around ? 2 : 1;  // each with its share of the rays
  const int samples = is_delta(light) ? 1 : std::max(1, lighting.light_samples / sides);
  const std::uint64_t seed = light_seed(lighting.seed, light);
  std::vector<Ray> shadow;
  std::vector<Arriving> arriving;
  const auto trace = [&] {
    rays_.occluded(shadow);
    for (std::size_t r = 0; r < shadow.size(); ++r) {
      if (shadow[r].far < 0) continue;
      const auto& [hit, cosine, irradiance, returned] = arriving[r];
      result.exitance[hit] += returned * irradiance;
      if (cosine > 0)
        result.irradiance[hit] +=
            irradiance * (cosine * (eta_ > 0 ? fresnel_transmittance(std::min(cosine, 1.f), eta_) : 1));
    }
    shadow.clear();
    arriving.clear();
  };
  for (std::size_t i = 0; i < lighting.points.size(); ++i) {
    const SurfacePoint& point = lighting.points[i];
    const auto [index, part] = part_of(lighting.keys[i]);
    const std::array<double, 2> shift{unit_double(hash_bits(seed, 2 * index)),
                                      unit_double(hash_bits(seed, 2 * index + 1))};
    for (int s = 0; s < samples * sides; ++s) {
      const auto& [normal, curvature] = smooth[i];
      const Vec3f about = s % sides == 0 ? normal : -normal;
      const std::array<double, 2> square =
          r2_point(part * std::uint64_t(samples) + std::uint64_t(s / sides), shift);
      std::array<float, 3> weights{};
      LightSample sample;
      if (std::holds_alternative<Surroundings>(light.source)) {
        sample = sample_hemisphere(about, square, samples);
        weights[0] = sample.weight;
      } else {
        sample = sample_lights(lights, point.position, about, square, samples, weights);
      }
      const float cosine = dot(normal, sample.direction);
      if (!(std::ranges::max(weights) > 0) || (sides == 2 && !(dot(about, sample.direction) > 0))) continue;
      Place place = smooth[i];
      float across = 0;
      if (dot(point.geometric, sample.direction) < 0) {
        across = thickness_along(point, sample.direction);
        place.curvature = curvature_through(cosine, curvature, across);
      }
      const RgbF returned = response(place, point.normal, sample.direction);
      const float near = std::max(across * 1.001f, nearest_) + point.offset;
      if (!(near < sample.distance) || !(max_component(returned) > 0)) continue;
      const Vec3f from = point.position + point.geometric * (across > 0 ? 0 : point.offset);
      shadow.emplace_back(from + sample.direction * near, sample.direction,
                          (sample.distance - near) * .9999f);
      RgbF irradiance;
      for (std::size_t l = 0; l < lights.size(); ++l) irradiance += RgbF(emission(lights[l])) * weights[l];
      arriving.push_back({std::uint32_t(i), dot(point.normal, sample.direction), irradiance, returned});
    }
    if (shadow.size() >= kAtOnce) trace();
  }
  trace();
}

LeavingLight PreintegratedField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                                    HeldView::Surface*) const {
  const std::size_t count = hits.points.size();
  std::vector<Place> smooth;
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < count; ++i) {
    smooth.push_back(smooth_at(hits.points[i], hits.hits[i]));
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
    light.exitance[i] += total_ * lighting.bounced[i];
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
