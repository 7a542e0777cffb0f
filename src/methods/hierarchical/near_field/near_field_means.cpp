// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/near_field/near_field_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opaline {
namespace {

// Least cosine of a sampled point's normal. Points at grazing angles are rarely sampled and have large
// weights: without a bound, a few of them dominate the mean. src/exitance/README.md has the comparison.
constexpr float kGrazing = 0.2f;

}  // namespace

NearFieldMeans::NearFieldMeans(const NearKernel& kernel, std::span<const SurfacePoint> points,
                               std::span<const std::uint32_t> chosen, std::span<const int> drawn)
    : kernel_(kernel), count_(chosen.size()), end_((count_ + kAtOnce - 1) / kAtOnce * kAtOnce) {
  for (std::size_t m = 0; m < count_; ++m) {
    const SurfacePoint& point = points[chosen[m]];
    const Vec3f &position = point.position, &normal = point.normal;
    x_[m] = position.x, y_[m] = position.y, z_[m] = position.z;
    nx_[m] = normal.x, ny_[m] = normal.y, nz_[m] = normal.z;
    if (!drawn.empty()) drawn_[m] = float(drawn[m]);
    Box& box = boxes_[m / kGroup];
    box.low = m % kGroup == 0 ? position : component_min(box.low, position);
    box.high = m % kGroup == 0 ? position : component_max(box.high, position);
  }
}

// Evaluates the kernels of all points at a surface point, 0 for back faces, and their sampling densities
// there. The kernel depends on the straight distance. Sampling picks a distance in the tangent plane and
// projects along the normal, so the density falls with the cosine.
void NearFieldMeans::find_densities(const SurfacePoint& place) {
  constexpr float kOutside = NearKernel::kRings;
  const float rings = kOutside / kernel_.radius;
  const float px = place.position.x, py = place.position.y, pz = place.position.z;
  const float gx = place.geometric.x, gy = place.geometric.y, gz = place.geometric.z;
  for (std::size_t m = 0; m < end_; ++m) {
    const float dx = x_[m] - px, dy = y_[m] - py, dz = z_[m] - pz;
    const float square = dx * dx + dy * dy + dz * dz, height = dx * nx_[m] + dy * ny_[m] + dz * nz_[m];
    const float flat = square - height * height, cosine = nx_[m] * gx + ny_[m] * gy + nz_[m] * gz;
    // Without a branch, so the compiler vectorizes the loop.
    const float r = std::sqrt(square) * rings, within = r < kOutside ? r : kOutside;
    const float drawn = std::sqrt(flat > 0 ? flat : 0) * rings,
                drawn_within = drawn < kOutside ? drawn : kOutside;
    ring_[m] = int(cosine > 0 ? within : kOutside);
    drawn_ring_[m] = int(cosine > 0 && height * height <= flat ? drawn_within : kOutside);
    found_[m] = drawn_[m] * (cosine > kGrazing ? cosine : kGrazing);
  }
  for (std::size_t m = 0; m < end_; ++m) here_[m] = kernel_.densities[std::size_t(ring_[m])];
}

void NearFieldMeans::add_drawn(std::span<const SurfacePoint> places, std::span<const RgbF> entered) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    find_densities(places[i]);
    float expected = 0;  // expected samples per mm^2
    for (std::size_t m = 0; m < end_; ++m)
      expected += kernel_.densities[std::size_t(drawn_ring_[m])][3] * found_[m];
    if (!(expected > 0)) continue;
    const Densities inverse = Densities{} + 1 / expected;
    const RgbF& e = entered[i];
    const Densities irradiance{e.x, e.y, e.z, 0};
    for (std::size_t m = 0; m < count_; ++m) {
      here_[m] *= inverse;
      weights_[m] += here_[m];
      sums_[m] += here_[m] * irradiance;
    }
  }
}

void NearFieldMeans::add_lattice(std::span<const IrradianceLattice::Cell* const> cells) {
  for (std::size_t first = 0; first < count_; first += kGroup) {
    for (std::vector<float>& coordinates : close_coordinates_) coordinates.clear();
    close_areas_.clear();
    close_entered_.clear();
    for (const IrradianceLattice::Cell* cell : cells) take_close(*cell, boxes_[first / kGroup]);
    close_rings_.resize(close_areas_.size());
    for (std::size_t m = first; m < std::min(first + kGroup, count_); ++m) add_close(m);
  }
}

// Copies the points of a cell within reach of a box.
void NearFieldMeans::take_close(const IrradianceLattice::Cell& cell, const Box& box) {
  const float square = kernel_.reach * kernel_.reach;
  const auto gap = [&box](const Vec3f& low, const Vec3f& high) {
    const Vec3f apart = component_max(component_max(box.low - high, low - box.high), Vec3f());
    return dot(apart, apart);
  };
  if (cell.points.empty() || gap(cell.low, cell.high) > square) return;
  std::size_t n = close_areas_.size();
  for (std::vector<float>& coordinates : close_coordinates_) coordinates.resize(n + cell.points.size());
  close_areas_.resize(n + cell.points.size());
  close_entered_.resize(n + cell.points.size());
  for (std::size_t i = 0; i < cell.points.size(); ++i) {
    const Vec3f &position = cell.points[i].position, &geometric = cell.points[i].geometric;
    if (gap(position, position) > square) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      close_coordinates_[axis][n] = position[axis];
      close_coordinates_[axis + 3][n] = geometric[axis];
    }
    close_areas_[n] = Densities{} + cell.areas[i];
    const RgbF& e = cell.entered[i];
    close_entered_[n] = Densities{e.x, e.y, e.z, 0};
    ++n;
  }
  for (std::vector<float>& coordinates : close_coordinates_) coordinates.resize(n);
  close_areas_.resize(n);
  close_entered_.resize(n);
}

// Adds the copied points to one point's mean.
void NearFieldMeans::add_close(std::size_t point) {
  constexpr float kOutside = NearKernel::kRings;
  const float rings = kOutside / kernel_.radius;
  const float x = x_[point], y = y_[point], z = z_[point], nx = nx_[point], ny = ny_[point], nz = nz_[point];
  const float *px = close_coordinates_[0].data(), *py = close_coordinates_[1].data(),
              *pz = close_coordinates_[2].data();
  const float *gx = close_coordinates_[3].data(), *gy = close_coordinates_[4].data(),
              *gz = close_coordinates_[5].data();
  int* const ring = close_rings_.data();
  const std::size_t n = close_rings_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float dx = x - px[i], dy = y - py[i], dz = z - pz[i];
    const float r = std::sqrt(dx * dx + dy * dy + dz * dz) * rings, within = r < kOutside ? r : kOutside;
    ring[i] = int(nx * gx[i] + ny * gy[i] + nz * gz[i] > 0 ? within : kOutside);
  }
  const Densities* const table = kernel_.densities.data();
  Densities weights{}, sum{};
  for (std::size_t i = 0; i < n; ++i) {
    const Densities weight = table[ring[i]] * close_areas_[i];
    weights += weight;
    sum += weight * close_entered_[i];
  }
  sums_[point] += sum;
  weights_[point] += weights;
}

RgbF NearFieldMeans::mean(std::size_t point) const {
  RgbF mean(std::numeric_limits<float>::quiet_NaN());
  for (std::size_t c = 0; c < 3; ++c)
    if (weights_[point][c] > 0) mean[c] = sums_[point][c] / weights_[point][c];
  return mean;
}

}  // namespace opaline
