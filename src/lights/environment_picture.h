// SPDX-License-Identifier: GPL-3.0-or-later
// Environment map: radiance by direction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// A lat-long image, twice as wide as high: +y at the top, +z in the middle, +x to its left, as in OpenEXR
/// (ImfEnvmap.h). Importance sampling for a surface is by the mean of the image's channels times the cosine:
/// first one of at most 64 x 32 blocks, from a table for the nearest of 17 x 17 normals, then a pixel of the
/// block by its brightness. (The normals are those of an unfolded octahedron: Cigolle et al. 2014; floor and
/// walls are among them.)
class EnvironmentPicture {
 public:
  /// in    pixels: rows from the top, all finite and >= 0
  EnvironmentPicture(std::size_t width, std::size_t height, std::vector<RgbF> pixels);

  /// Reads the display window of a file, black outside the data window. Returns the same object while the
  /// file is unchanged and in use. Negative radiance becomes 0, see warning().
  /// error Error{bad_input}: as read_image; not the shape of an environment; a non-finite value
  /// in    from_rgb: ThreeWavelengths::from_rgb for its colours; null: red, green and blue
  static std::shared_ptr<const EnvironmentPicture> read(const std::string& path,
                                                        const std::array<Rgb, 3>* from_rgb = nullptr);
  const std::string& path() const { return path_; }  ///< path of the source file; empty: none

  /// in    direction: unit
  RgbF radiance(const Vec3d& direction) const;

  /// A direction, and radiance over its density: their mean over the unit square, for directions above the
  /// surface, is the integral over all directions above it.
  struct Sample {
    Vec3d direction;
    RgbF weight;
    float assumed_cosine = 0;  ///< cosine in the means of `unshadowed`; 0: the direction's own
    std::uint32_t block = 0;   ///< block of the direction: row by row from the top
  };
  /// in    normal: unit, of the surface; some directions below it are sampled, too
  ///       turn: about +y, degrees, from the image to the world
  Sample sample(std::array<double, 2> unit_square, const Vec3d& normal, double turn = 0) const;
  /// Samples at several points in one batch, because the tables exceed the processor caches.
  void sample(std::span<const std::array<double, 2>> unit_squares, const Vec3d& normal, double turn,
              std::span<Sample> samples) const;
  /// Mean over the unit square of a sample's weight times its assumed cosine: the unoccluded irradiance of a
  /// surface, except from near its horizon.
  RgbF unshadowed(const Vec3d& normal) const { return unshadowed_[nearest_normal(normal)].at(normal); }
  /// That mean, for all normals near a tabulated one.
  struct Unshadowed {
    std::array<Vec3d, 3> above{};  ///< blocks above the horizon: radiance times direction, per channel
    Rgb others;                    ///< radiance times the assumed cosine
    RgbF at(const Vec3d& normal) const {
      return RgbF(others + Rgb{dot(normal, above[0]), dot(normal, above[1]), dot(normal, above[2])});
    }
  };
  /// The same with a visible fraction of each block.
  /// in    parts: one per block, in [0, 1]
  Unshadowed unshadowed(std::size_t nearest_normal, std::span<const float> parts) const;
  /// Index of the nearest tabulated normal.
  static std::size_t nearest_normal(const Vec3d& normal);
  std::size_t block_count() const { return block_flux_.size(); }
  std::size_t block_columns() const { return block_columns_; }
  /// Density of sample(), 1/sr.
  float density(const Vec3d& direction, const Vec3d& normal) const;

  /// Cumulative table of the blocks reflected by a lobe, and of the brightest ones, by brightness and lobe.
  /// Empty if the lobe is wide enough for cosine sampling, or if everything it reflects is dark.
  struct InLobe {
    std::vector<std::uint16_t> blocks;  ///< in order
    std::vector<float> ends;
  };
  /// in    mirrored, alpha: as in Lobe; normal: unit, of the surface
  InLobe blocks_in_lobe(const Vec3d& mirrored, float alpha, const Vec3d& normal) const;
  /// Like sample() and its density, but seven of eight directions are in blocks of the lobe.
  void sample(std::span<const std::array<double, 2>> unit_squares, const Vec3d& normal, const InLobe& lobe,
              double turn, std::span<Sample> samples) const;
  float density(const Vec3d& direction, const Vec3d& normal, const InLobe& lobe) const;

  /// Warning naming the negative pixels of the file; empty: none.
  const std::string& warning() const { return warning_; }
  bool is_grey() const { return is_grey_; }
  /// Peak memory of reading: four channels of the file beside the pixels and their tables; bytes.
  std::size_t memory() const;
  /// Hash of the pixels.
  std::uint64_t hash() const { return hash_; }

 private:
  static constexpr std::size_t kNormals = 17;  ///< along each side of the unfolded octahedron

  /// Column and row, in pixels, from the image's corner.
  std::array<double, 2> place_of(const Vec3d& direction) const;
  Vec3d direction_of(std::array<double, 2> place) const;
  void make_means();
  void make_importance();
  void make_blocks();
  void make_cosine_tables();
  /// Integrals over a block's directions: of the radiance, and of the radiance times the direction in each
  /// channel.
  struct BlockIntegral {
    Rgb radiance;
    std::array<Vec3d, 3> vectors{};
  };
  std::vector<BlockIntegral> block_integrals() const;
  double flux_of(std::size_t row, std::size_t column) const;
  std::size_t cell_of(const Vec3d& direction) const;
  double block_share(std::size_t normal, std::size_t block) const;
  double block_share(std::size_t normal, std::size_t block, const InLobe& lobe) const;
  /// A point of the unit square during sampling of the tables.
  struct Place {
    double u, v;
    std::size_t block, row, column;
  };
  std::size_t draw_block(std::size_t normal, double& u, double& v) const;
  std::size_t draw_block(std::size_t normal, const InLobe& lobe, double& u, double& v) const;
  template <class... Lobe>
  float density_in_block(const Vec3d& direction, const Vec3d& normal, const Lobe&... lobe) const;
  template <class... Lobe>
  void sample_blocks(std::span<const std::array<double, 2>> unit_squares, std::size_t normal, double turn,
                     std::span<Sample> samples, const Lobe&... lobe) const;

  std::size_t width_, height_;
  std::vector<RgbF> pixels_;
  bool is_grey_ = true;
  std::string path_;
  std::uint64_t hash_ = 0;
  std::string warning_;
  // Cells: means over pixels, for large images.
  std::size_t step_ = 1, columns_ = 0, rows_ = 0;
  std::vector<double> row_cosines_;  ///< row cosines of the angles from +y at the rows' borders
  struct Cell {
    RgbF mean;
    float importance = 0;  ///< its brightness, including a fraction of its neighbours'
  };
  std::vector<Cell> cells_;
  // Blocks of cells.
  std::size_t block_ = 1, block_columns_ = 0, block_rows_ = 0;
  std::vector<double> block_flux_;  ///< integral of the importance over a block's directions
  std::vector<float> cell_rows_;    ///< cumulative shares of a block's rows, one block column after the other
  std::vector<float> cell_columns_;  ///< cumulative shares of a row's cells within each block
  std::vector<float> block_row_ends_, block_column_ends_;  ///< cumulative shares of blocks, for each normal
  std::vector<float>
      assumed_cosines_;  ///< per block and normal; 0: that of the sample; < 0: the block is not sampled
  std::vector<BlockIntegral> integrals_;
  std::vector<Vec3f> middles_;            ///< middles of blocks
  std::vector<std::uint16_t> brightest_;  ///< the brightest blocks
  std::vector<Unshadowed> unshadowed_;
};

}  // namespace opaline
