// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/irradiance/light_sampling.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "opaline/core/random.h"

namespace opaline {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;  // clang 14 does not deduce aggregates

LightSample sample(const PointLight& light, const Vec3f& point) {
  const Vec3f to_light = Vec3f(light.position) - point;
  const float d2 = dot(to_light, to_light);
  if (!(d2 > 0)) return {};
  const float d = std::sqrt(d2);
  return {to_light / d, d, 1 / d2};
}

LightSample sample(const DirectionalLight& light) {
  return {Vec3f(-light.direction), kInfinity, 1};
}

// Uniform over the cone that the sphere fills; from inside it, over all directions.
LightSample sample(const SphereLight& light, const Vec3f& point, std::array<double, 2> xi, int samples) {
  const Vec3d to_center = light.center - Vec3d(point);
  const double d2 = dot(to_center, to_center), r2 = light.radius * light.radius;
  const double phi = 2 * std::numbers::pi * xi[1];
  const bool inside = d2 <= r2;
  // 1 - cos of the cone's half angle, without cancellation for a small, far sphere.
  const double sin2 = inside ? 1 : r2 / d2;
  const double one_minus_cos = inside ? 2 : sin2 / (1 + std::sqrt(1 - sin2));
  const double drop = one_minus_cos * xi[0], cosine = 1 - drop,
               sine = std::sqrt(std::max(0.0, drop * (2 - drop)));
  const Vec3d axis = inside ? Vec3d{0, 0, 1} : to_center / std::sqrt(d2);
  Vec3d x, y;
  tangent_frame(axis, x, y);
  const Vec3d direction = x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) + axis * cosine;
  const double along = dot(to_center, direction), miss2 = d2 - along * along;
  const double half_chord = std::sqrt(std::max(0.0, r2 - miss2));
  const double distance = inside ? along + half_chord : along - half_chord;
  return {Vec3f(direction), float(distance), float(2 * std::numbers::pi * one_minus_cos / samples)};
}

LightSample sample(const QuadLight& light, const Vec3f& point, std::array<double, 2> xi, int samples) {
  const Vec3d to_light = light.corner + light.u * xi[0] + light.v * xi[1] - Vec3d(point);
  const double d2 = dot(to_light, to_light);
  const Vec3d area_normal = cross(light.u, light.v);  // as long as the area
  const double facing = -dot(area_normal, to_light);
  if (!(d2 > 0) || facing <= 0) return {};
  const double d = std::sqrt(d2);
  return {Vec3f(to_light / d), float(d), float(facing / (d2 * d * samples))};
}

// Proportional to the cosine, so that the cosine times this weight is constant.
LightSample sample(const Surroundings&, const Vec3f& normal, std::array<double, 2> xi, int samples) {
  const double radius2 = xi[0], cosine = std::sqrt(1 - radius2), phi = 2 * std::numbers::pi * xi[1];
  const double radius = std::sqrt(radius2);
  Vec3f x, y;
  tangent_frame(normal, x, y);
  const Vec3f direction =
      x * float(radius * std::cos(phi)) + y * float(radius * std::sin(phi)) + normal * float(cosine);
  return {direction, kInfinity, float(std::numbers::pi / (cosine * samples))};
}

}  // namespace

Rgb emission(const Light& light) {
  return std::visit(Overloaded{[](const PointLight& l) { return l.intensity; },
                               [](const DirectionalLight& l) { return l.irradiance; },
                               [](const auto& l) { return l.radiance; }},
                    light.source);
}

bool is_delta(const Light& light) {
  return std::holds_alternative<PointLight>(light.source) ||
         std::holds_alternative<DirectionalLight>(light.source);
}

std::uint64_t light_seed(std::uint64_t seed, const Light& light) {
  std::uint64_t name = 0;
  for (const char c : light.name) name = hash_bits(name, std::uint8_t(c));
  return hash_bits(seed, name);
}

Light recentred(const Light& light, const Vec3d& origin, double unit) {
  Light moved = light;
  std::visit(Overloaded{[&](PointLight& l) {
                          l.position = (l.position - origin) / unit;
                          l.intensity = l.intensity / unit / unit;
                        },
                        [&](SphereLight& l) {
                          l.center = (l.center - origin) / unit;
                          l.radius /= unit;
                        },
                        [&](QuadLight& l) {
                          l.corner = (l.corner - origin) / unit;
                          l.u = l.u / unit;
                          l.v = l.v / unit;
                        },
                        [](auto&) {}},
             moved.source);
  return moved;
}

LightSample sample_light(const Light& light, const Vec3f& point, const Vec3f& normal,
                         std::array<double, 2> unit_square, int samples) {
  return std::visit(
      Overloaded{[&](const PointLight& l) { return sample(l, point); },
                 [&](const DirectionalLight& l) { return sample(l); },
                 [&](const SphereLight& l) { return sample(l, point, unit_square, samples); },
                 [&](const QuadLight& l) { return sample(l, point, unit_square, samples); },
                 [&](const Surroundings& l) { return sample(l, normal, unit_square, samples); }},
      light.source);
}

EmitterHit intersect_emitter(const Light& light, const Vec3f& origin, const Vec3f& direction, float far) {
  const Vec3d o(origin), d(direction);
  if (const auto* sphere = std::get_if<SphereLight>(&light.source)) {
    const Vec3d to_center = sphere->center - o;
    const double a = dot(d, d), b = dot(to_center, d);
    const Vec3d closest = to_center - d * (b / a);
    const double inside = sphere->radius * sphere->radius - dot(closest, closest);
    if (inside < 0) return {};
    const double half = std::sqrt(inside / a), t = b / a - half > 0 ? b / a - half : b / a + half;
    if (t > 0 && t < far) return {true, float(t), RgbF(sphere->radiance)};
  } else if (const auto* quad = std::get_if<QuadLight>(&light.source)) {
    const Vec3d n = cross(quad->u, quad->v);
    const double facing = dot(d, n);
    if (facing >= 0) return {};
    const double t = dot(quad->corner - o, n) / facing;
    if (!(t > 0 && t < far)) return {};
    const Vec3d p = o + d * t - quad->corner;
    const double n2 = dot(n, n), u = dot(cross(p, quad->v), n) / n2, v = dot(cross(quad->u, p), n) / n2;
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) return {true, float(t), RgbF(quad->radiance)};
  }
  return {};
}

}  // namespace opaline
