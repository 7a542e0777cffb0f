// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth field over a surface from its means over cells.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "volume/nearest_sample.h"

namespace opaline {

/// Weights of neighbouring means in each cell's quadratic. They depend on cell positions only, so fits to other means of
/// the same cells share them; 700 bytes per cell.
class CellWeights {
 public:
  explicit CellWeights(std::span<const SurfaceSample> samples);

 private:
  friend class CellFit;
  /// Where the cells lie.
  struct Places {
    explicit Places(std::span<const SurfaceSample> samples);
    NearestSample middles;
    std::vector<std::uint32_t> of_sample;  ///< its place among middles.members()
    float spacing = 1;                     ///< root of the cells' mean area, mm
  };
  struct Frame {
    Vec3f along_u, along_v;
    float moment;  ///< mean of u^2 and of v^2 over the cell, spacings
  };
  struct Neighbour {
    std::uint32_t sample;
    float closeness;  ///< weight with which its surprise counts here
  };
  /// Weights of kChunk cells, in spatial order.
  struct Chunk {
    std::vector<Frame> frames;                ///< one a cell
    std::vector<std::uint32_t> ends;          ///< end of each cell's neighbours
    std::vector<Neighbour> neighbours;        ///< those of a cell after those of the one before
    std::vector<std::array<float, 6>> terms;  ///< one a neighbour: of the quadratic, for a mean of 1 there
  };
  static Chunk chunk_of(const Places& places, std::span<const SurfaceSample> samples, std::size_t begin,
                        std::size_t end);

  std::shared_ptr<const Places> places_;
  std::vector<Chunk> chunks_;
};

/// Around each cell a quadratic of the place in its tangent plane is fitted to the means of the cells near it; at a
/// point the fits of the cells around are blended. A quadratic field on a plane comes out exactly. All is linear
/// in the means: noise in them becomes noise, not bias.
class CellFit {
 public:
  /// in    means, errors: of the samples' cells, one each; errors: standard, independent of each other
  CellFit(std::span<const SurfaceSample> samples, std::span<const RgbF> means, std::span<const RgbF> errors);
  /// The same, bit for bit, by weights of these samples.
  CellFit(const CellWeights& weights, std::span<const RgbF> means, std::span<const RgbF> errors);

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
    struct FourWeights {
      std::array<Four, 3> apart;  // offset of the point from their centres, in spacings
      Four weight;
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
    std::vector<FourCells> fours_;     // the same cells, four to a vector
    // Scratch of `at`: what it finds of these cells for its point, and which of them it blends.
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
  std::vector<Fit> fits_;  ///< one a cell, in the order of their places
};

}  // namespace opaline
