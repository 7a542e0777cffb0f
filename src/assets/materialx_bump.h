// SPDX-License-Identifier: GPL-3.0-or-later
// Bumps of MaterialX surfaces.
#pragma once

#include <array>
#include <pugixml.hpp>
#include <string>

namespace opaline {

/// The picture of heights of a `bump` node.
struct HeightMap {
  std::string file;  ///< as the document has it, relative to its folder; empty: there is none
  double scale = 1;  ///< the height of white, scene units
  std::array<double, 2> tiling{1, 1};
  std::string problem;  ///< why there is none
};

/// Height map of the bump node that drives a surface's normal, from an image or a tiledimage.
/// in    normal: an input
HeightMap height_map(const pugi::xml_node& normal);

}  // namespace opaline
