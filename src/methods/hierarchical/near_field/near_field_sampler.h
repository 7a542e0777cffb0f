// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance of the near field beside shadow edges.
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

/// Mean irradiance around points, weighted by the near kernel R_d (1 - w). By default the near field has one
/// irradiance, a mixture of the point's own and the samples' mean (SplitKernel::own_irradiance). If the two
/// differ, a shadow edge crosses the near field and the mixture is wrong, so shadow rays from points of the
/// near field replace it. Dense points, such as pixels, share a lattice (IrradianceLattice), finer at higher
/// stakes: its error beside an edge is of order 3/2 in the spacing. Sparse points sample their kernels, in
/// numbers proportional to the expected deviation, and share the samples with neighbours.
/// from  balance heuristic: Veach & Guibas 1995, sec. 3; allocation: Neyman 1934; stratified sampling of
///       edges: Mitchell 1996
class NearFieldSampler {
 public:
  /// in    group: has meshes; must outlive the sampler. light_samples: shadow rays from a point to each light
  ///       with an area, the maximum for refine. held: lattice of earlier images, reused if it fits,
  ///       otherwise replaced; null: none is cached
  explicit NearFieldSampler(const Body& group, int light_samples,
                            std::shared_ptr<IrradianceLattice>* held = nullptr);

  /// Corrects the exitance of points beside shadow edges; returns their indices.
  /// in    lighting: of the points; own: their irradiance
  /// out   exitance: evaluated with `own`, one per point; noise: its variance, one per point; both replaced
  ///       at the returned points
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
