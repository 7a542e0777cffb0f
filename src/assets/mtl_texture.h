// SPDX-License-Identifier: GPL-3.0-or-later
// Texture statement of an MTL file: options, then a file's name, possibly with blanks.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace opaline {

struct MtlTexture {
  std::string name;                      ///< as in the file
  std::array<double, 2> scale{1, 1};     ///< -s: of UVs, v upwards
  std::array<double, 2> offset{0, 0};    ///< -o: added after scaling
  double base = 0, gain = 1;             ///< numbers of -mm; the base is not supported
  double bump = 1;                       ///< -bm
  std::vector<std::string> not_carried;  ///< unknown options, and unsupported ones that change the image
};

/// in    text: after the keyword
MtlTexture read_mtl_texture(std::string_view text);

}  // namespace opaline
