// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/presets.h"

#include <array>
#include <vector>

namespace opaline {

std::span<const Preset> presets() {
  // name, {sigma_a, sigma_s_prime} in 1/mm, eta
  static const std::array<Preset, 12> table{{
      {"apple", {{.0030, .0034, .046}, {2.29, 2.39, 1.97}}, 1.3},
      {"chicken1", {{.015, .077, .19}, {0.15, 0.21, 0.38}}, 1.3},
      {"chicken2", {{.018, .088, .20}, {0.19, 0.25, 0.32}}, 1.3},
      {"cream", {{.0002, .0028, .0163}, {7.38, 5.47, 3.15}}, 1.3},
      {"ketchup", {{.061, .97, 1.45}, {0.18, 0.07, 0.03}}, 1.3},
      {"marble", {{.0021, .0041, .0071}, {2.19, 2.62, 3.00}}, 1.5},
      {"potato", {{.0024, .0090, .12}, {0.68, 0.70, 0.55}}, 1.3},
      {"skimmilk", {{.0014, .0025, .0142}, {0.70, 1.22, 1.90}}, 1.3},
      {"skin1", {{.032, .17, .48}, {0.74, 0.88, 1.01}}, 1.3},
      {"skin2", {{.013, .070, .145}, {1.09, 1.59, 1.79}}, 1.3},
      {"spectralon", {{0, 0, 0}, {11.6, 20.4, 14.9}}, 1.3},
      {"wholemilk", {{.0011, .0024, .014}, {2.55, 3.21, 3.77}}, 1.3},
  }};
  return table;
}

std::span<const std::string_view> preset_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Preset& preset : presets()) all.push_back(preset.name);
    return all;
  }();
  return names;
}

}  // namespace opaline
