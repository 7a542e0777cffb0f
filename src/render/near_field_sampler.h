// SPDX-License-Identifier: GPL-3.0-or-later
// The irradiance of the near field beside shadow edges.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "opaline/render/precompute.h"

namespace opaline {

/// Places around a point, drawn from the near kernel R_d (1 - w). evaluate gives the near field one
/// irradiance, that of the point mixed with the samples' mean (SplitKernel::own_irradiance); where the two
/// differ, a shadow edge runs through the near field and neither is what enters it. Shadow rays from these
/// places tell.
class NearFieldSampler {
 public:
  /// group: not without meshes; it must outlive the sampler.
  explicit NearFieldSampler(const TranslucentGroup& group);

  /// Corrects the exitance of the points beside shadow edges.
  /// in    lighting: of the points; own: their irradiance
  /// out   exitance: as evaluated with it, one a point; returns which points these were
  std::vector<std::uint32_t> refine(const PointIrradianceInput& lighting, std::span<const RgbF> own,
                                    std::span<Exitance> exitance) const;

 private:
  static constexpr std::size_t kPlaces = 16;
  struct Place {
    float distance = 0;  // from the point, mm, in its tangent plane
    RgbF weight{};       // the part of the near kernel that it stands for; the sum over the places is 1
  };
  struct Places;
  bool is_beside_edge(const RgbF& own, const Exitance& exitance) const;
  void add_places(const SurfacePoint& point, std::uint32_t index, std::uint64_t key, Places& places) const;
  void find(const RayScene& rays, Places& places) const;

  const SplitKernel& kernel_;
  std::vector<bool> is_own_mesh_;
  std::array<Place, kPlaces> pattern_;
};

}  // namespace opaline
