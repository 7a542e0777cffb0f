// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth field over a surface from its means over cells.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "opaline/volume/nearest_sample.h"

namespace opaline {

/// Around each cell a quadratic of the place in its tangent plane is fitted to the means of the cells near it; at a
/// point the fits of the cells around are blended. A quadratic field on a plane comes out exactly. All is linear
/// in the means: noise in them becomes noise, not bias.
class CellFit {
 public:
  /// in    means, errors: of the samples' cells, one each; errors: standard, independent of each other
  CellFit(std::span<const SurfaceSample> samples, std::span<const RgbF> means, std::span<const RgbF> errors);

  struct Value {
    RgbF value;  ///< >= 0
    RgbF noise;  ///< standard error that the means' errors give it
    RgbF shape;  ///< estimated standard error that the fit gives it, where it does not follow the field
  };
  /// At a point of the surface, by its position and shading normal.
  Value at(const Vec3f& position, const Vec3f& normal) const;

 private:
  struct Fit {
    Vec3f center, along_u, along_v;
    std::array<RgbF, 6> terms;  ///< of 1, u, v, u^2, u v, v^2; u, v: spacings
    RgbF noise, shape;
  };
  /// What a cell has to do with another one.
  struct Share {
    std::uint32_t sample;
    float weight;
  };
  /// What is fitted to.
  struct Cell {
    RgbF mean, error;
    float area;
  };
  /// What is known of a cell beside its fit while that of all is made.
  struct Surprise {
    Rgb square{};
    std::vector<Share> near;  ///< the cells over which it is averaged
  };
  template <class Use>
  void for_alike(const Vec3f& position, const Vec3f& normal, float spacings, const Use& use) const;
  Fit fitted(const NearestSample::Member& own, std::span<const Cell> cells, Surprise& surprise) const;
  RgbF value_of(const Fit& fit, const Vec3f& position) const;

  NearestSample middles_;  ///< of the cells
  std::vector<Fit> fits_;  ///< one a cell
  float spacing_ = 1;
};

}  // namespace opaline
