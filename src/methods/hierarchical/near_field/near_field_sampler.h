// SPDX-License-Identifier: GPL-3.0-or-later
// The irradiance of the near field beside shadow edges.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bodies/body.h"
#include "exitance/evaluate.h"
#include "irradiance/irradiance_lattice.h"
#include "methods/hierarchical/near_field/near_field_means.h"
#include "methods/hierarchical/near_field/near_kernel.h"

namespace opaline {

/// Irradiance around points, weighted by the near kernel R_d (1 - w). evaluate gives the near field one
/// irradiance, that of the point mixed with the samples' mean (SplitKernel::own_irradiance); where the two
/// differ, a shadow edge runs through the near field and neither is what enters it. Shadow rays from places
/// in it tell. Where many points lie close together, as pixels do, the places are those of a lattice that all
/// of them share (IrradianceLattice), the finer the more hangs on it: an edge leaves an error of the spacing
/// to the power of 3/2. Elsewhere points draw places from their own kernels. Neighbours share these: each
/// counts as drawn from the mean of the points' own kernels. Points bring as many as goes with the deviation
/// that is to be expected.
/// from  balance heuristic: Veach & Guibas 1995, sec. 3; allocation: Neyman 1934; stratified sampling of
///       edges: Mitchell 1996
class NearFieldSampler {
 public:
  /// in    group: not without meshes; it must outlive the sampler. light_samples: from a point to each light with an
  /// area, the most that refine is given. held: where it is the one that the group needs, of earlier
  /// pictures; else replaced by one for this and later ones. Null: none is kept
  explicit NearFieldSampler(const Body& group, int light_samples,
                            std::shared_ptr<IrradianceLattice>* held = nullptr);

  /// Corrects the exitance of the points beside shadow edges.
  /// in    lighting: of the points; own: their irradiance
  /// out   exitance: as evaluated with it, one a point; noise: its variance, one a point, replaced at those
  ///       beside shadow edges; returns which points these were
  std::vector<std::uint32_t> refine(const PointIrradianceInput& lighting, std::span<const RgbF> own,
                                    std::span<Exitance> exitance, std::span<Rgb> noise) const;

 private:
  struct Places;
  struct Found;
  float at_stake(const RgbF& own, const Exitance& exitance) const;
  std::optional<std::uint32_t> finest_level(double apart, std::size_t marked) const;
  std::uint32_t level_of(const Found& found, std::span<const std::uint32_t> set, std::uint32_t finest) const;
  static std::vector<std::size_t> split(std::span<const SurfacePoint> points,
                                        std::span<std::uint32_t> marked);
  static void sort_into_groups(std::span<const SurfacePoint> points, std::span<std::uint32_t> set);
  static void part(std::span<const SurfacePoint> points, std::span<std::uint32_t> marked, std::size_t count);
  void look_up(const Found& found, std::span<std::uint32_t> open, std::span<const std::size_t> ends,
               std::uint32_t level) const;
  void draw_all(const Found& found, std::span<const std::uint32_t> open,
                std::span<const std::size_t> ends) const;
  float places_of(std::uint32_t point, std::span<const std::uint32_t> set,
                  std::span<const SurfacePoint> points) const;
  void draw(const PointIrradianceInput& lighting, std::uint32_t number, int count, Places& places) const;
  void find(const RayScene& rays, Places& places) const;
  void replace_all(const Found& found, std::span<const std::uint32_t> points, const NearFieldMeans& means,
                   const RgbF& variance) const;
  void replace_mixed(const RgbF& own, const RgbF& mean, const RgbF& variance, Exitance& e, Rgb& noise) const;

  const SplitKernel& kernel_;
  NearKernel near_;
  std::vector<bool> is_own_mesh_;
  std::shared_ptr<IrradianceLattice> lattice_;
};

}  // namespace opaline
