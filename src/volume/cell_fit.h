// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth field over a surface, from its means over cells.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "volume/nearest_sample.h"

namespace opaline {

/// Weights of neighbouring means in each cell's quadratic. They depend on cell positions only, so fits of
/// other means on the same cells share them; 700 bytes per cell.
class CellWeights {
 public:
  explicit CellWeights(std::span<const SurfaceSample> samples);

 private:
  friend class CellFit;
  /// Positions of the cells.
  struct Places {
    explicit Places(std::span<const SurfaceSample> samples);
    NearestSample middles;
    std::vector<std::uint32_t> of_sample;  ///< index into middles.members()
    float spacing = 1;                     ///< root of the cells' mean area, mm
  };
  struct Frame {
    Vec3f along_u, along_v;
    float moment;  ///< mean of u^2 and of v^2 over the cell, spacings^2
  };
  struct Neighbour {
    std::uint32_t sample;
    float closeness;  ///< weight of its squared residual
  };
  /// Weights of kChunk cells, in spatial order.
  struct Chunk {
    std::vector<Frame> frames;                ///< one per cell
    std::vector<std::uint32_t> ends;          ///< end of each cell's neighbours
    std::vector<Neighbour> neighbours;        ///< cell by cell
    std::vector<std::array<float, 6>> terms;  ///< one per neighbour: its quadratic for a mean of 1
  };
  static Chunk chunk_of(const Places& places, std::span<const SurfaceSample> samples, std::size_t begin,
                        std::size_t end);

  std::shared_ptr<const Places> places_;
  std::vector<Chunk> chunks_;
};

/// Weighted least-squares fit: each cell has a quadratic over its tangent plane, fitted to the means of
/// nearby cells; a point blends the quadratics of the cells around it. Exact for quadratic fields on a plane.
/// Linear in the means, so their noise causes noise, not bias.
class CellFit {
 public:
  /// in    means, errors: one per sample's cell; errors: standard, mutually independent
  CellFit(std::span<const SurfaceSample> samples, std::span<const RgbF> means, std::span<const RgbF> errors);
  /// The same bits, from weights of the same samples. No errors: noise and shape are 0.
  CellFit(const CellWeights& weights, std::span<const RgbF> means, std::span<const RgbF> errors);

  struct Value {
    RgbF value;  ///< >= 0
    RgbF noise;  ///< standard error from the means' errors
    RgbF shape;  ///< estimated standard error from fitting a quadratic to the field
  };
  /// Evaluates the field point by point; faster with expect().
  class Reader {
    typedef float Four __attribute__((vector_size(16)));
    struct FourCells {
      std::array<Four, 3> middle, normal;
    };
    struct FourWeights {
      std::array<Four, 3> apart;  // offset of the point from the cells' centres, spacings
      Four weight;
    };

   public:
    /// It must outlive the reader.
    explicit Reader(const CellFit& fit);
    /// Announces the next points, to speed up `at`; results do not depend on it.
    void expect(std::span<const Vec3f> positions);
    /// Value at a point of the surface, by its position and shading normal.
    Value at(const Vec3f& position, const Vec3f& normal);

   private:
    void take_around(const Vec3f& position, float beyond);

    const CellFit& fit_;
    Vec3f taken_;                      // centre of the ball with cached cells
    float beyond_ = 0;                 // its radius, spacings
    std::vector<std::uint32_t> near_;  // indices of the cached cells
    std::vector<FourCells> fours_;     // the same cells, four to a vector
    // Scratch of `at`: weights of the cells at its point, and indices of the nonzero ones.
    std::vector<FourWeights> weighed_;
    std::vector<std::uint32_t> blended_;
  };
  Value at(const Vec3f& position, const Vec3f& normal) const { return Reader(*this).at(position, normal); }

 private:
  typedef float Channels __attribute__((vector_size(16)));  ///< red, green, blue, 0
  struct Fit {
    Vec3f along_u, along_v;
    std::array<Channels, 6> terms;  ///< coefficients of 1, u, v, u^2, u v, v^2; u, v: spacings
    Channels noise, shape;
  };

  void fit(const CellWeights::Chunk& chunk, std::size_t begin, std::span<const RgbF> means,
           std::span<const RgbF> errors, std::span<Rgb> surprises);
  void smooth(std::span<const CellWeights::Chunk> chunks, std::vector<Rgb> surprises);

  static Channels channels_of(const RgbF& rgb) { return Channels{rgb[0], rgb[1], rgb[2], 0}; }
  static RgbF rgb_of(const Channels& channels) { return {channels[0], channels[1], channels[2]}; }

  std::shared_ptr<const CellWeights::Places> places_;
  std::vector<Fit> fits_;  ///< one per cell, in spatial order
};

}  // namespace opaline
