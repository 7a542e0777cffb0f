// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of vertices and faces in mesh files.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// Encoding of numbers from 0 to 1.
enum class ColorCoding { srgb, linear };

/// Collects a file's colours of vertices or faces. Missing ones are white.
class FileColors {
 public:
  explicit FileColors(ColorCoding coding) : coding_(coding) {}

  bool empty() const { return colors_.empty(); }
  /// The color of the element with this index; indices ascend.
  void set(std::size_t index, const RgbF& color) {
    colors_.resize(index, kNone);
    colors_.push_back(color);
  }
  /// From the file's scale to one ending at 1.
  void divide_by(float one) {
    for (RgbF& color : colors_)
      if (color != kNone) color = color / one;
  }
  /// Linear, in [0, 1], one per element. Integer colours with a value above 1 have a maximum of 255 and are
  /// sRGB.
  std::vector<RgbF> linear(std::size_t elements) const;

 private:
  static constexpr RgbF kNone{-1, -1, -1};

  ColorCoding coding_;
  std::vector<RgbF> colors_;
};

/// Gives the triangles' corners the colors of their vertices.
void give_vertex_colors(SourceMesh& mesh, const std::vector<RgbF>& colors);

}  // namespace opaline
