// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/presets.h"

#include <array>
#include <vector>

namespace opaline {

std::span<const Preset> presets() {
  // name, {sigma_a, sigma_s_prime} in 1/mm, eta, roughness
  static const std::array<Preset, 25> table{{
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
      {"alabaster", {{.00011, .00028, .0010}, {0.62, 0.67, 0.77}}, 1.52, .2},
      {"candle", {{.00008, .0015, .030}, {0.67, 0.91, 1.40}}, 1.44, .35},
      {"grape", {{.0068, .0026, .35}, {0.38, 0.38, 0.65}}, 1.35, .15},
      {"honey", {{.00066, .015, .92}, {0.45, 0.54, 0.33}}, 1.49},
      {"jade", {{.038, .0023, .021}, {0.38, 0.28, 0.36}}, 1.61, .15},
      {"leaf", {{2.5, .54, 6.1}, {5.90, 6.60, 3.90}}, 1.42, .4},
      {"milk_glass", {{.00007, .00007, .00006}, {1.70, 1.70, 1.80}}, 1.52},
      {"salmon", {{.00064, .059, .27}, {0.62, 1.10, 1.40}}, 1.37, .15},
      {"skin_dark", {{.072, .52, 1.3}, {0.93, 1.70, 2.00}}, 1.4, .3},
      {"skin_fair", {{.0021, .031, .11}, {0.83, 1.80, 2.70}}, 1.4, .3},
      {"snow", {{.00008, .00006, .00002}, {2.00, 2.00, 2.00}}, 1.31, 1},
      {"soap", {{.00047, .0011, .0054}, {1.40, 1.50, 1.80}}, 1.46, .3},
      {"wax", {{.00015, .00036, .0010}, {0.91, 1.00, 1.20}}, 1.43, .35},
  }};
  return table;
}

std::span<const Preset> measured_presets() {
  return presets().first(12);
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
