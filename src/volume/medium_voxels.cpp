// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/medium_voxels.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace opaline {

MediumVoxels::MediumVoxels(const MediaInside& media, const Bounds& box, double edge) : low_(box.low) {
  const Vec3d size = box.high - box.low;
  edge_ = std::max(edge, std::cbrt(size.x * size.y * size.z / kMost));
  for (std::size_t axis = 0; axis < 3; ++axis)
    counts_[axis] = std::size_t(std::max(1., std::ceil(size[axis] / edge_)));
  voxels_.resize(counts_[0] * counts_[1] * counts_[2]);
  parallel_chunks(voxels_.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d place(double(i % counts_[0]), double(i / counts_[0] % counts_[1]),
                        double(i / counts_[0] / counts_[1]));
      const std::array<HomogeneousMedium, 3> here = media(low_ + (place + Vec3d(.5)) * edge_, edge_);
      for (std::size_t c = 0; c < 3; ++c) voxels_[i][c] = {float(here[c].sigma_t()), float(here[c].albedo())};
    }
  });
  densest_ = media(low_ + size * .5, edge_);
  for (std::size_t c = 0; c < 3; ++c) {
    float most = 0;
    for (const std::array<Local, 3>& voxel : voxels_) most = std::max(most, voxel[c].sigma_t);
    densest_[c].sigma_a = 0;
    densest_[c].sigma_s = double(most);
  }
}

const MediumVoxels::Local& MediumVoxels::at(const Vec3d& position, std::size_t channel) const {
  const Vec3d place = (position - low_) * (1 / edge_);
  std::size_t index = 0;
  for (std::size_t axis = 3; axis-- > 0;)
    index = index * counts_[axis] + std::size_t(std::clamp(place[axis], 0., double(counts_[axis]) - .5));
  return voxels_[index][channel];
}

}  // namespace opaline
