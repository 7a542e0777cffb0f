// SPDX-License-Identifier: GPL-3.0-or-later
// Images of MaterialX surfaces.
#pragma once

#include <array>
#include <pugixml.hpp>
#include <string>

namespace opaline {

/// An `image` or `tiledimage` node.
struct ImageNode {
  std::string file;  ///< as in the document, relative to its folder; empty: none
  std::array<double, 2> tiling{1, 1};
  std::string color_space{};  ///< as in the document
  std::string problem;        ///< reason for an empty file
};

/// Image connected to an input, directly or through a graph.
ImageNode connected_image(const pugi::xml_node& input);

/// Height map of a `bump` node.
struct HeightMap {
  ImageNode image;
  double scale = 1;  ///< the height of white, scene units
};

/// Height map of the bump node connected to a surface's normal, from an image or a tiledimage.
/// in    normal: an input
HeightMap height_map(const pugi::xml_node& normal);

}  // namespace opaline
