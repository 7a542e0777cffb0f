// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/safe_distance.h"

#include <algorithm>
#include <cmath>

#include "opaline/core/parallel.h"

namespace opaline {
namespace {

constexpr int kReach = 15;  // voxels: 15^2 fits into a byte
constexpr std::uint8_t kFar = kReach * kReach;

/// Squared gap between voxels that are `steps` apart along one axis: those that touch have none.
constexpr int gap2(int steps) {
  const int gap = std::max(0, std::abs(steps) - 1);
  return gap * gap;
}

/// Whether the plane of a triangle may cross a box: (middle, half edge), normal of any length.
bool crosses(const Vec3d& corner, const Vec3d& normal, const Vec3d& middle, double half) {
  const double reach = half * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  return std::abs(dot(normal, middle - corner)) <= reach * (1 + 1e-9);
}

}  // namespace

SafeDistance::SafeDistance(const World& world, const Bounds& box, double edge) {
  const Vec3d size = box.high - box.low;
  const auto count = [](double length, double e) { return std::floor(length / e) + 3; };
  edge_ = std::max(edge, max_component(size) * 1e-3);
  while (count(size.x, edge_) * count(size.y, edge_) * count(size.z, edge_) > double(kMostVoxels))
    edge_ *= 1.1;
  if (!(edge_ > 0)) edge_ = 1;
  inverse_edge_ = 1 / edge_;
  counts_ = {count(size.x, edge_), count(size.y, edge_), count(size.z, edge_)};
  nx_ = std::size_t(counts_.x), ny_ = std::size_t(counts_.y), nz_ = std::size_t(counts_.z);
  low_ = .5 * (box.low + box.high) - .5 * edge_ * counts_;
  for (std::size_t i = 0; i < distances_.size(); ++i)
    distances_[i] = std::sqrt(double(i)) * edge_ * (1 - 1e-6);
  steps_.assign(nx_ * ny_ * nz_, kFar);
  mark(world);
  spread();
}

void SafeDistance::mark(const World& world) {
  for (const Mesh& mesh : world.meshes)
    for (const auto& [i, j, k] : mesh.triangles)
      mark(mesh.positions[i], mesh.positions[j], mesh.positions[k]);
}

// The voxels of the triangle's box that its plane crosses, and a little more: rays see single precision.
void SafeDistance::mark(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double margin = 1e-5 * edge_ * (double(nx_) + double(ny_) + double(nz_));
  const auto voxel = [&](double at, double low, std::size_t n) {
    return std::clamp((at - low) * inverse_edge_, -1.0, double(n));
  };
  const Vec3d low = component_min(component_min(a, b), c) - Vec3d(margin),
              high = component_max(component_max(a, b), c) + Vec3d(margin), normal = cross(b - a, c - a);
  const auto first = [&](double at, double from, std::size_t n) {
    return std::size_t(std::max(0.0, std::floor(voxel(at, from, n))));
  };
  const auto end = [&](double at, double from, std::size_t n) {
    return std::min(n, std::size_t(std::floor(voxel(at, from, n)) + 1));
  };
  const std::size_t x0 = first(low.x, low_.x, nx_), x1 = end(high.x, low_.x, nx_),
                    y0 = first(low.y, low_.y, ny_), y1 = end(high.y, low_.y, ny_),
                    z0 = first(low.z, low_.z, nz_), z1 = end(high.z, low_.z, nz_);
  for (std::size_t z = z0; z < z1; ++z)
    for (std::size_t y = y0; y < y1; ++y)
      for (std::size_t x = x0; x < x1; ++x) {
        const Vec3d middle = low_ + Vec3d(double(x) + .5, double(y) + .5, double(z) + .5) * edge_;
        if (crosses(a, normal, middle, .5 * edge_ + margin)) steps_[x + nx_ * (y + ny_ * z)] = 0;
      }
}

// Least squared gap to a marked voxel, axis by axis: gaps along the axes are independent.
void SafeDistance::spread() {
  const auto along = [&](std::size_t lines, std::size_t length, std::size_t stride, const auto& start) {
    parallel_chunks(lines, 64, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::vector<int> before(length);
      for (std::size_t line = begin; line < end; ++line) {
        std::uint8_t* at = steps_.data() + start(line);
        bool is_far = true;
        for (std::size_t i = 0; i < length; ++i) {
          before[i] = at[i * stride];
          is_far = is_far && before[i] == kFar;
        }
        if (is_far) continue;
        for (std::size_t i = 0; i < length; ++i) {
          int least = kFar;
          const std::size_t first = i < kReach ? 0 : i - kReach, last = std::min(length - 1, i + kReach);
          for (std::size_t j = first; j <= last; ++j)
            least = std::min(least, before[j] + gap2(int(j) - int(i)));
          at[i * stride] = std::uint8_t(least);
        }
      }
    });
  };
  along(ny_ * nz_, nx_, 1, [&](std::size_t line) { return line * nx_; });
  along(nx_ * nz_, ny_, nx_, [&](std::size_t line) { return line % nx_ + line / nx_ * nx_ * ny_; });
  along(nx_ * ny_, nz_, nx_ * ny_, [&](std::size_t line) { return line; });
}

}  // namespace opaline
