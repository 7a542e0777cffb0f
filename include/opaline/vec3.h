// SPDX-License-Identifier: GPL-3.0-or-later
// Three-component values: points, directions (Vec3d, Vec3f) and linear Rec.709 colours (Rgb, RgbF).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace opaline {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3() = default;
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  explicit constexpr Vec3(T all) : x(all), y(all), z(all) {}
  template <class U>
  explicit constexpr Vec3(const Vec3<U>& other) : x(T(other.x)), y(T(other.y)), z(T(other.z)) {}

  constexpr T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }

  constexpr Vec3& operator+=(const Vec3& o) { return *this = *this + o; }
  constexpr Vec3& operator-=(const Vec3& o) { return *this = *this - o; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }

  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
  friend constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr bool operator==(const Vec3& a, const Vec3& b) = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using RgbF = Vec3<float>;
using Rgb = Vec3<double>;

/// a . b.
template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// |a|.
template <class T>
T length(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}

/// Unit vector along a; the zero vector stays zero.
template <class T>
Vec3<T> normalized(const Vec3<T>& a) {
  const T l = length(a);
  return l > T(0) ? a / l : Vec3<T>{};
}

/// Largest component.
template <class T>
constexpr T max_component(const Vec3<T>& a) {
  return std::max(a.x, std::max(a.y, a.z));
}

/// Smallest component.
template <class T>
constexpr T min_component(const Vec3<T>& a) {
  return std::min(a.x, std::min(a.y, a.z));
}

template <class T>
constexpr Vec3<T> component_min(const Vec3<T>& a, const Vec3<T>& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

template <class T>
constexpr Vec3<T> component_max(const Vec3<T>& a, const Vec3<T>& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Extends the box from low to high to contain p.
template <class T>
constexpr void widen(Vec3<T>& low, Vec3<T>& high, const Vec3<T>& p) {
  low = component_min(low, p);
  high = component_max(high, p);
}

/// True if all components are finite.
template <class T>
bool is_finite(const Vec3<T>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Two unit vectors completing unit n to a right-handed frame (Duff et al. 2017, Building an Orthonormal
/// Basis, Revisited).
template <class T>
void tangent_frame(const Vec3<T>& n, Vec3<T>& tangent, Vec3<T>& bitangent) {
  const T sign = std::copysign(T(1), n.z);
  const T a = T(-1) / (sign + n.z);
  const T b = n.x * n.y * a;
  tangent = {T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
  bitangent = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace opaline
