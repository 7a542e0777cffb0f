// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth field over a surface from its means over cells.
#pragma once

#include <array>
#include <cstdint>
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
  /// Reads the field at one point after another, fastest where it was told which follow.
  class Reader {
    typedef float Four __attribute__((vector_size(16)));
    struct FourCells {
      std::array<Four, 3> middle, normal;
    };

   public:
    /// It must outlive the reader.
    explicit Reader(const CellFit& fit);
    /// Says which points are asked for next; they change how long it takes, not what comes out.
    void expect(std::span<const Vec3f> positions);
    /// At a point of the surface, by its position and shading normal.
    Value at(const Vec3f& position, const Vec3f& normal);

   private:
    void take_around(const Vec3f& position, float beyond);

    const CellFit& fit_;
    Vec3f taken_;                      // the place whose cells are taken, and of points so far off:
    float beyond_ = 0;                 // spacings
    std::vector<std::uint32_t> near_;  // these cells, by their places
    std::vector<FourCells> fours_;
  };
  Value at(const Vec3f& position, const Vec3f& normal) const { return Reader(*this).at(position, normal); }

 private:
  typedef float Channels __attribute__((vector_size(16)));  ///< red, green, blue, 0
  struct Fit {
    Vec3f along_u, along_v;
    std::array<Channels, 6> terms;  ///< of 1, u, v, u^2, u v, v^2; u, v: spacings
    Channels noise, shape;
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
  static Channels channels_of(const RgbF& rgb) { return Channels{rgb[0], rgb[1], rgb[2], 0}; }
  static RgbF rgb_of(const Channels& channels) { return {channels[0], channels[1], channels[2]}; }

  NearestSample middles_;              ///< of the cells
  std::vector<Fit> fits_;              ///< one for each of its members
  std::vector<std::uint32_t> places_;  ///< of the cells there
  float spacing_ = 1;
};

}  // namespace opaline
