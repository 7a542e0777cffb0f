// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of all that is around, as radiance by direction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "opaline/core/vec3.h"

namespace opaline {

/// A lat-long picture, twice as wide as high: +y at the top, +z in the middle, +x left of it, as OpenEXR has them
/// (OpenEXR, ImfEnvmap.h). Directions are drawn with a density in proportion to the mean of its channels.
class EnvironmentPicture {
 public:
  /// in    pixels: rows from the top, all finite and >= 0
  EnvironmentPicture(std::size_t width, std::size_t height, std::vector<RgbF> pixels);

  /// The picture of a file; the same object while the file has not changed and somebody holds it.
  /// error Error{bad_input}: as read_image; the shape or a value is not that of an environment
  static std::shared_ptr<const EnvironmentPicture> read(const std::string& path);

  /// in    direction: unit
  RgbF radiance(const Vec3d& direction) const;

  /// A direction, and radiance over its density: their mean over the unit square is the integral over all directions.
  struct Sample {
    Vec3d direction;
    RgbF weight;
  };
  Sample sample(std::array<double, 2> unit_square) const;
  /// Of sample(), 1/sr.
  float density(const Vec3d& direction) const;

  bool is_grey() const { return is_grey_; }
  /// Of the pixels.
  std::uint64_t hash() const { return hash_; }

 private:
  /// Column and row, in pixels, from the picture's corner.
  std::array<double, 2> place_of(const Vec3d& direction) const;
  void make_table();

  std::size_t width_, height_;
  std::vector<RgbF> pixels_;
  bool is_grey_ = true;
  std::uint64_t hash_ = 0;
  // Directions are drawn from means over pixels, where there are many.
  std::size_t step_ = 1, columns_ = 0, rows_ = 0;
  std::vector<RgbF> means_;
  std::vector<float> row_ends_, column_ends_;  ///< cumulative shares: of rows, and within each row
  double total_ = 0;                           ///< integral of the channels' mean over all directions
};

}  // namespace opaline
