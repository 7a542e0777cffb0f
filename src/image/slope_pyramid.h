// SPDX-License-Identifier: GPL-3.0-or-later
// Squared slopes of an image of heights, averaged.
#pragma once

#include <array>
#include <vector>

namespace opaline {

/// Means of squared slopes over square cells of 4 x 4 texels and more. The slopes are those of cubic B-splines, at texels.
class SlopePyramid {
 public:
  SlopePyramid(int width, int height);
  /// Adds the next row, from above.
  void add_row(std::vector<float> heights);

  /// Derivatives along the image, to the right squared, right times down, and down squared.
  /// in    u, v: as TexturePlace; texels: width of the footprint
  std::array<float, 3> at(float u, float v, float texels) const;

 private:
  using Squares = std::array<float, 3>;
  struct Level {
    int width = 0, height = 0;
    std::vector<Squares> cells;
    Squares at(float u, float v) const;  ///< bilinear, repeated
  };
  void add_slopes(int y, const std::vector<float>& below);
  void finish();

  int width_, height_, next_row_ = 0;
  std::vector<float> above_, row_;  // the last two rows
  std::vector<Level> levels_;
};

}  // namespace opaline
