// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/medium_voxels.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace opaline {

namespace {

constexpr double kPoint = 1e-3;  // edge of a cube taken for a point, edges of a voxel

MediumVoxels::Local local(const HomogeneousMedium& medium) {
  return {float(medium.sigma_t()), float(medium.albedo())};
}

std::array<MediumVoxels::Local, 3> locals(const std::array<HomogeneousMedium, 3>& media) {
  return {local(media[0]), local(media[1]), local(media[2])};
}

/// Up to the rounding of a mean of equal values.
bool same(const std::array<MediumVoxels::Local, 3>& a, const std::array<MediumVoxels::Local, 3>& b) {
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(a[c].sigma_t - b[c].sigma_t) > 1e-6f * b[c].sigma_t ||
        std::abs(a[c].albedo - b[c].albedo) > 1e-6f)
      return false;
  return true;
}

}  // namespace

MediumVoxels::MediumVoxels(const MediaInside& media, const Bounds& box, double edge,
                           std::span<const std::array<HomogeneousMedium, 3>> layers)
    : media_(media), low_(box.low) {
  const Vec3d size = box.high - box.low;
  edge_ = std::max(edge, std::cbrt(size.x * size.y * size.z / kMost));
  for (std::size_t axis = 0; axis < 3; ++axis)
    counts_[axis] = std::size_t(std::max(1., std::ceil(size[axis] / edge_)));
  std::array<Local, 3> deepest{};
  if (!layers.empty()) deepest = locals(layers.back());
  voxels_.resize(counts_[0] * counts_[1] * counts_[2]);
  parallel_chunks(voxels_.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d place(double(i % counts_[0]), double(i / counts_[0] % counts_[1]),
                        double(i / counts_[0] / counts_[1]));
      const Vec3d centre = low_ + (place + Vec3d(.5)) * edge_;
      if (layers.empty()) {
        voxels_[i] = locals(media(centre, edge_));
        continue;
      }
      // Depths differ by at most the distance to the centre, or a little more under textured layers.
      const std::array<Local, 3> around = locals(media(centre, 2 * edge_));
      voxels_[i] = around;
      if (!same(around, deepest) && !same(around, locals(media(centre, kPoint * edge_))))
        for (Local& voxel : voxels_[i]) voxel.sigma_t = kSeveral;
    }
  });
  densest_ = media(low_ + size * .5, edge_);
  for (std::size_t c = 0; c < 3; ++c) {
    float most = 0;
    for (const std::array<HomogeneousMedium, 3>& layer : layers)
      most = std::max(most, local(layer[c]).sigma_t);
    for (const std::array<Local, 3>& voxel : voxels_) most = std::max(most, voxel[c].sigma_t);
    densest_[c].sigma_a = 0;
    densest_[c].sigma_s = double(most);
  }
}

MediumVoxels::Local MediumVoxels::at(const Vec3d& position, std::size_t channel) const {
  const Vec3d place = (position - low_) * (1 / edge_);
  std::size_t index = 0;
  for (std::size_t axis = 3; axis-- > 0;)
    index = index * counts_[axis] + std::size_t(std::clamp(place[axis], 0., double(counts_[axis]) - .5));
  const Local& voxel = voxels_[index][channel];
  return voxel.sigma_t == kSeveral ? local(media_(position, kPoint * edge_)[channel]) : voxel;
}

}  // namespace opaline
