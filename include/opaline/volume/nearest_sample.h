// SPDX-License-Identifier: GPL-3.0-or-later
// The samples around a point of a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "opaline/sampling/sample_surface.h"

namespace opaline {

/// Samples whose normals face away from the point's are of another sheet and never found.
class NearestSample {
 public:
  explicit NearestSample(std::span<const SurfaceSample> samples);
  ~NearestSample();

  /// Index of the nearest sample; the cell that the point lies in is that sample's.
  std::uint32_t at(const Vec3f& position, const Vec3f& normal) const;

  /// A mean of values, one a sample: weights (1 - t^2)^2, t = distance / radius below 1; the nearest one's where
  /// there is none.
  RgbF interpolate(std::span<const RgbF> values, const Vec3f& position, const Vec3f& normal,
                   float radius) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace opaline
