// SPDX-License-Identifier: GPL-3.0-or-later
// The irradiance of the near field beside shadow edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "opaline/render/held_view.h"
#include "opaline/render/precompute.h"

namespace opaline {

/// Places around points, drawn from the near kernel R_d (1 - w). evaluate gives the near field one
/// irradiance, that of the point mixed with the samples' mean (SplitKernel::own_irradiance); where the two
/// differ, a shadow edge runs through the near field and neither is what enters it. Shadow rays from these
/// places tell. Neighbouring points share their places: each counts as drawn from the mean of the points' own
/// kernels. Points bring as many as goes with the deviation that is to be expected.
/// from  balance heuristic: Veach & Guibas 1995, sec. 3; allocation: Neyman 1934
class NearFieldSampler {
 public:
  /// group: not without meshes; it must outlive the sampler.
  explicit NearFieldSampler(const Body& group);

  /// Corrects the exitance of the points beside shadow edges.
  /// in    lighting: of the points; own: their irradiance
  /// held: found earlier at the same points beside lights in the same places, and added to; or null
  /// out   exitance: as evaluated with it, one a point; noise: its variance, one a point, replaced at those
  ///       beside shadow edges; returns which points these were
  std::vector<std::uint32_t> refine(const PointIrradianceInput& lighting, std::span<const RgbF> own,
                                    std::span<Exitance> exitance, std::span<Rgb> noise,
                                    HeldView::NearField* held = nullptr) const;

 private:
  static constexpr std::size_t kRings = 1024;  // of equal width, out to h
  struct Places;
  struct Means;
  /// Of the near kernel, whose integral is 1, per channel, and their mean, 1/mm^2.
  typedef float Densities __attribute__((vector_size(16)));
  float at_stake(const RgbF& own, const Exitance& exitance) const;
  static std::vector<std::size_t> split(std::span<const SurfacePoint> points,
                                        std::span<std::uint32_t> marked);
  float places_of(std::uint32_t point, std::span<const std::uint32_t> set,
                  std::span<const SurfacePoint> points) const;
  void draw(const PointIrradianceInput& lighting, std::uint32_t number, int count, Places& places) const;
  void find(const RayScene& rays, Places& places) const;
  double drawn_distance(double u) const;
  void add_held(const HeldView::NearField& held, const PointIrradianceInput& lighting,
                std::span<const RgbF> own, std::span<const std::uint32_t> points,
                std::span<Exitance> exitance, std::span<Rgb> noise) const;
  void replace_mixed(const RgbF& own, const RgbF& mean, Exitance& e, Rgb& noise) const;
  Means means_of(std::span<const SurfacePoint> points, std::span<const std::uint32_t> marked,
                 std::span<const int> drawn, std::span<const SurfacePoint> places,
                 std::span<const std::span<const RgbF>> entered) const;

  const SplitKernel& kernel_;
  std::uint64_t key_ = 0;  // of the near kernel
  std::vector<bool> is_own_mesh_;
  std::array<Densities, kRings + 1> densities_{};  // ring by ring; 0 beyond h
  std::array<double, kRings + 1> within_{};  // the part of the channels' mean within a ring's inner edge
  double root_mean_square_ = 0;              // distance, mm
};

}  // namespace opaline
