// SPDX-License-Identifier: GPL-3.0-or-later
// Bumps of MaterialX surfaces.
#pragma once

#include <array>
#include <pugixml.hpp>
#include <string>

namespace opaline {

/// Height map of a `bump` node.
struct HeightMap {
  std::string file;  ///< as in the document, relative to its folder; empty: none
  double scale = 1;  ///< the height of white, scene units
  std::array<double, 2> tiling{1, 1};
  std::string problem;  ///< reason for an empty file
};

/// Height map of the bump node connected to a surface's normal, from an image or a tiledimage.
/// in    normal: an input
HeightMap height_map(const pugi::xml_node& normal);

}  // namespace opaline
