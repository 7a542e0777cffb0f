// SPDX-License-Identifier: GPL-3.0-or-later
// A texture statement of an MTL file: options, then a file's name, which may have blanks in it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace opaline {

struct MtlTexture {
  std::string name;                      ///< as the file has it
  std::array<double, 2> scale{1, 1};     ///< -s: of UVs, v upwards
  std::array<double, 2> offset{0, 0};    ///< -o: added to them then
  double gain = 1, bump = 1;             ///< second number of -mm, and -bm
  std::vector<std::string> not_carried;  ///< options that change the image and have no counterpart
};

/// in    text: behind the keyword
MtlTexture read_mtl_texture(std::string_view text);

}  // namespace opaline
