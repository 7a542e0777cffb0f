// SPDX-License-Identifier: GPL-3.0-or-later
// Indirect light gathered at points.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/shade.h"
#include "subsurface/held_view.h"

namespace opaline {

/// Points traced and shaded together. Hierarchical evaluation of many points over all directions takes half
/// the time of small sets.
inline constexpr std::size_t kGatheredAtOnce = 1024;

/// Light gathered at points, by rays over the hemisphere, from surfaces.
struct GatherInput {
  const RayScene& rays;
  const Shader& shader;
  std::span<const SurfacePoint> points;
  std::span<const std::uint64_t> keys;  ///< one per point: chooses its random numbers
  OuterBoundary boundary = {};          ///< boundary transmitting the light
  int rays_each = 64;
  std::uint64_t seed = 0;
  /// Cached hits of the same points, keys, number and seed, extended up to gathered_bytes of the view; or
  /// null.
  HeldView::Gathering* held = nullptr;
  HeldView* view = nullptr;  ///< cache containing it
};

/// Light reaching a point from a surface.
struct SurfaceLight {
  std::size_t point;  ///< its index
  Vec3f towards;      ///< the surface; unit
  float distance;     ///< to it, world units
  RgbF irradiance;    ///< irradiance transmitted by the boundary, if any, W/mm^2
  RgbF further;       ///< its part by earlier bounces
};

using UseOfGathered = std::function<void(const SurfaceLight&)>;

void for_each_gathered(const GatherInput& input, const UseOfGathered& use);

/// A gathering for some points of a batch, by their indices: emptied if it was for others.
HeldView::Gathering& gathering_of(HeldView::Gathering& held, const std::vector<std::uint32_t>& points);
HeldView::Gathering& gathering_of(std::unique_ptr<HeldView::Gathering>& held,
                                  const std::vector<std::uint32_t>& points);

/// Their sums, one per point, W/mm^2.
std::vector<RgbF> gathered_irradiance(const GatherInput& input);

}  // namespace opaline
