// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of all that is around, as radiance by direction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "opaline/core/vec3.h"

namespace opaline {

/// A lat-long picture, twice as wide as high: +y at the top, +z in the middle, +x left of it, as OpenEXR has them
/// (OpenEXR, ImfEnvmap.h). Directions are drawn for a surface, by the mean of the picture's channels times the cosine:
/// first one of at most 64 x 32 blocks, from a table for the nearest of 17 x 17 normals, then a pixel of the block by
/// its brightness. (The normals are an octahedron's, unfolded: Cigolle et al. 2014; floor and walls are among them.)
class EnvironmentPicture {
 public:
  /// in    pixels: rows from the top, all finite and >= 0
  EnvironmentPicture(std::size_t width, std::size_t height, std::vector<RgbF> pixels);

  /// The picture of a file; the same object while the file has not changed and somebody holds it.
  /// error Error{bad_input}: as read_image; the shape or a value is not that of an environment
  static std::shared_ptr<const EnvironmentPicture> read(const std::string& path);

  /// in    direction: unit
  RgbF radiance(const Vec3d& direction) const;

  /// A direction, and radiance over its density: their mean over the unit square, where the direction is above the
  /// surface, is the integral over all directions above it.
  struct Sample {
    Vec3d direction;
    RgbF weight;
    float assumed_cosine = 0;  ///< in the means of `unshadowed`, in place of its own; 0: its own
  };
  /// in    normal: unit, of the surface, where some directions below it are drawn, too
  ///       turn: about +y, degrees, from the picture to where the direction is wanted
  Sample sample(std::array<double, 2> unit_square, const Vec3d& normal, double turn = 0) const;
  /// Of several places: the tables are larger than caches, and are asked for all at once.
  void sample(std::span<const std::array<double, 2>> unit_squares, const Vec3d& normal, double turn,
              std::span<Sample> samples) const;
  /// The mean over the unit square of a sample's weight times its assumed cosine: the irradiance of a surface that
  /// nothing shadows, but for what comes from near its horizon.
  RgbF unshadowed(const Vec3d& normal) const;
  /// Of sample(), 1/sr.
  float density(const Vec3d& direction, const Vec3d& normal) const;

  bool is_grey() const { return is_grey_; }
  /// At most, while it is read: four channels of the file beside the pixels and their tables; bytes.
  std::size_t memory() const;
  /// Of the pixels.
  std::uint64_t hash() const { return hash_; }

 private:
  /// Column and row, in pixels, from the picture's corner.
  std::array<double, 2> place_of(const Vec3d& direction) const;
  Vec3d direction_of(std::array<double, 2> place) const;
  void make_means();
  void make_importance();
  void make_blocks();
  void make_cosine_tables();
  /// Over a block's directions: of the radiance, and of the radiance times the direction in each channel.
  struct BlockIntegral {
    Rgb radiance;
    std::array<Vec3d, 3> vectors{};
  };
  std::vector<BlockIntegral> block_integrals() const;
  double flux_of(std::size_t row, std::size_t column) const;
  double block_share(std::size_t normal, std::size_t block_row, std::size_t block_column) const;

  std::size_t width_, height_;
  std::vector<RgbF> pixels_;
  bool is_grey_ = true;
  std::uint64_t hash_ = 0;
  // Cells: means over pixels, where there are many.
  std::size_t step_ = 1, columns_ = 0, rows_ = 0;
  std::vector<double> row_cosines_;  ///< of the angles from +y at the rows' borders
  struct Cell {
    RgbF mean;
    float importance = 0;  ///< its brightness and a little of its neighbours'
  };
  std::vector<Cell> cells_;
  // Blocks of cells.
  std::size_t block_ = 1, block_columns_ = 0, block_rows_ = 0;
  std::vector<double> block_flux_;  ///< integral of the importance over a block's directions
  std::vector<float> cell_rows_;    ///< cumulative shares of a block's rows, one block column after the other
  std::vector<float> cell_columns_;  ///< cumulative shares of a row's cells within each block
  std::vector<float> block_row_ends_, block_column_ends_;  ///< cumulative shares of blocks, for each normal
  std::vector<float> assumed_cosines_;  ///< of blocks, for each normal; 0: the sample's own
  /// Of a normal: of blocks that are wholly above it the integral of radiance times direction, channel by channel, and
  /// of others radiance times the assumed cosine.
  struct Unshadowed {
    std::array<Vec3d, 3> above{};
    Rgb others;
  };
  std::vector<Unshadowed> unshadowed_;
};

}  // namespace opaline
