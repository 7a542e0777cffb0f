// SPDX-License-Identifier: GPL-3.0-or-later
// Rectangular light emitting on one side.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "lights/light_kind.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const QuadLight&) {
  using enum ValueType;
  return {{.key = "type",
           .type = choice,
           .meaning = "`\"quad\"`: a flat area light that emits on the side of u x v"},
          {.key = "corner", .type = point, .meaning = "one corner"},
          {.key = "u", .type = point, .meaning = "vector from the corner along one side"},
          {.key = "v",
           .type = point,
           .meaning = "vector from the corner along the other side, not parallel to `u`"},
          {.key = "radiance",
           .type = color,
           .unit = "W/(mm² sr)",
           .range = kNonNegative,
           .meaning = "emitted radiance"}};
}

inline void read_light(const ObjectReader& reader, double mm_per_unit, QuadLight& light) {
  const Value v_value = reader.need("v");
  const Vec3d u = reader.need("u").point(mm_per_unit), v = v_value.point(mm_per_unit);
  check_parallelogram(u, v, v_value);
  light = {reader.need("corner").point(mm_per_unit), u, v, reader.need("radiance").color()};
}

inline bool is_delta(const QuadLight&) {
  return false;
}

inline QuadLight recentred(QuadLight light, const Vec3d& origin, double unit) {
  light.corner = (light.corner - origin) / unit;
  light.u = light.u / unit;
  light.v = light.v / unit;
  return light;
}

/// A rectangle seen from a point close to its bright side, with samples uniform in solid angle.
/// from  Urena, Fajardo and King 2013, An Area-Preserving Parametrization for Spherical Rectangles
class NearRectangle {
 public:
  /// None: farther than half of its longer side, a skew parallelogram, or too thin a solid angle.
  static std::optional<NearRectangle> of(const QuadLight& light, const Vec3d& point) {
    constexpr double kNear = .5, kSkew = 1e-6, kThinnest = 1e-9;
    const double width2 = dot(light.u, light.u), height2 = dot(light.v, light.v);
    if (std::abs(dot(light.u, light.v)) > kSkew * std::sqrt(width2 * height2)) return {};
    const Vec3d from_corner = point - light.corner;
    const Vec3d nearest = light.u * std::clamp(dot(from_corner, light.u) / width2, 0., 1.) +
                          light.v * std::clamp(dot(from_corner, light.v) / height2, 0., 1.);
    const Vec3d apart = from_corner - nearest;
    if (dot(apart, apart) > kNear * kNear * std::max(width2, height2)) return {};
    const NearRectangle rectangle(light, from_corner, std::sqrt(width2), std::sqrt(height2));
    if (!(rectangle.depth_ < 0 && rectangle.solid_angle_ > kThinnest)) return {};
    return rectangle;
  }

  double solid_angle() const { return solid_angle_; }

  /// Vector from the point to a sample. The first number divides the rectangle by planes through the point and along its
  /// height, the second one this line.
  Vec3d sample(std::array<double, 2> unit_square) const {
    const double angle = unit_square[0] * solid_angle_ + first_angle_;
    const double f = -(std::cos(angle) * low_sine_ + high_sine_) / std::sin(angle);
    const double c = std::clamp(std::copysign(1 / std::hypot(f, low_sine_), f), -1., 1.);
    const double across =
                     std::clamp(-c * depth_ / std::sqrt(std::max(1 - c * c, 1e-30)), left_, left_ + width_),
                 d = std::hypot(across, depth_), low = low_ / std::hypot(d, low_), high_end = low_ + height_,
                 high = high_end / std::hypot(d, high_end), h = low + unit_square[1] * (high - low);
    const double up = std::clamp(h * d / std::sqrt(std::max(1 - h * h, 1e-30)), low_, high_end);
    return x_ * across + y_ * up + z_ * depth_;
  }

 private:
  NearRectangle(const QuadLight& light, const Vec3d& from_corner, double width, double height)
      : x_(light.u / width), y_(light.v / height), z_(cross(x_, y_)), width_(width), height_(height) {
    left_ = -dot(from_corner, x_), low_ = -dot(from_corner, y_), depth_ = -dot(from_corner, z_);
    const auto sine = [&](double side) { return side / std::hypot(side, depth_); };
    const double left = sine(left_), right = sine(left_ + width);
    low_sine_ = sine(low_), high_sine_ = sine(low_ + height);
    const double last = std::acos(high_sine_ * left) + std::acos(-left * low_sine_);
    solid_angle_ =
        std::acos(low_sine_ * right) + std::acos(-right * high_sine_) + last - 2 * std::numbers::pi;
    first_angle_ = 2 * std::numbers::pi - last;
  }

  Vec3d x_, y_, z_;  // along the sides, and the normal
  double width_, height_;
  double left_ = 0, low_ = 0, depth_ = 0;  // the corner, from the point
  double low_sine_ = 0, high_sine_ = 0;    // angles between the normal and both sides along x
  double solid_angle_ = 0, first_angle_ = 0;
};

inline LightSample sample_light(const QuadLight& light, const Vec3f& point, const Vec3f&,
                                std::array<double, 2> unit_square, int samples) {
  if (const auto near = NearRectangle::of(light, Vec3d(point))) {
    const Vec3d to_light = near->sample(unit_square);
    const double d = length(to_light);
    return {Vec3f(to_light / d), float(d), float(near->solid_angle() / samples)};
  }
  const Vec3d to_light = light.corner + light.u * unit_square[0] + light.v * unit_square[1] - Vec3d(point);
  const double d2 = dot(to_light, to_light);
  const Vec3d area_normal = cross(light.u, light.v);  // its length is the area
  const double facing = -dot(area_normal, to_light);
  if (!(d2 > 0) || facing <= 0) return {};
  const double d = std::sqrt(d2);
  return {Vec3f(to_light / d), float(d), float(facing / (d2 * d * samples))};
}

inline EmitterHit intersect_emitter(const QuadLight& light, const Vec3f& origin, const Vec3f& direction,
                                    float far) {
  const Vec3d o(origin), d(direction);
  const Vec3d n = cross(light.u, light.v);
  const double facing = dot(d, n);
  if (facing >= 0) return {};
  const double t = dot(light.corner - o, n) / facing;
  if (!(t > 0 && t < far)) return {};
  const Vec3d p = o + d * t - light.corner;
  const double n2 = dot(n, n), u = dot(cross(p, light.v), n) / n2, v = dot(cross(light.u, p), n) / n2;
  if (u >= 0 && u <= 1 && v >= 0 && v <= 1) return {true, float(t), RgbF(light.radiance)};
  return {};
}

inline float sampling_density(const QuadLight& light, const Vec3f& point, const Vec3f&,
                              const Vec3f& direction) {
  const EmitterHit met = intersect_emitter(light, point, direction, std::numeric_limits<float>::infinity());
  if (!met.hit) return 0;
  if (const auto near = NearRectangle::of(light, Vec3d(point))) return float(1 / near->solid_angle());
  const double facing = -dot(cross(light.u, light.v), Vec3d(direction));
  return float(double(met.t) * double(met.t) / facing);
}

inline RgbF background(const QuadLight&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const QuadLight& light) {
  const double radius = 0.5 * std::max(length(light.u + light.v), length(light.u - light.v));
  const bool u_is_longer = length(light.u) > length(light.v);
  const Vec3d along = u_is_longer ? light.u : light.v, across = u_is_longer ? light.v : light.u;
  return {.center = light.corner + 0.5 * (light.u + light.v),
          .radius = radius,
          .width = length(cross(along, across)) / length(along),
          .along = along,
          .facing = normalized(cross(normalized(light.u), normalized(light.v)))};
}

inline std::optional<Lamp> lamp_of(const QuadLight& light) {
  const LightExtent place = extent(light);
  return Lamp{.center = *place.center,
              .radius = place.radius,
              .facing = place.facing,
              .full = 0,
              .reach = std::numbers::pi / 2,
              .intensity = length(cross(light.u, light.v))};
}

inline std::vector<double> geometry(const QuadLight& light) {
  return {light.corner.x, light.corner.y, light.corner.z, light.u.x, light.u.y,
          light.u.z,      light.v.x,      light.v.y,      light.v.z};
}

}  // namespace opaline
