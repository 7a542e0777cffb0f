// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume/cell_warnings.h"

#include <fmt/format.h>

namespace opaline {

std::vector<std::string> cell_warnings(const Body& body, const VolumeExitance& exitance) {
  constexpr double kMuch = 1e-3;  // of the light that entered
  std::vector<std::string> warnings;
  if (const double lost = max_component(exitance.lost); lost > kMuch)
    warnings.push_back(
        fmt::format("{}: {:.2g} % of the light that entered got out through holes of its meshes and is in "
                    "no picture; close them (fill_holes)",
                    body.plan.name, 100 * lost));
  if (const double stopped = max_component(exitance.stopped); stopped > kMuch)
    warnings.push_back(
        fmt::format("{}: {:.2g} % of the light that entered ended at other shapes inside of it; move them "
                    "apart, or put shapes of one medium into one group",
                    body.plan.name, 100 * stopped));
  if (exitance.has_inner_sheets)
    warnings.push_back(
        fmt::format("{}: parts of its surface lie inside of it; random walks go through them, and samples "
                    "there are dark",
                    body.plan.name));
  return warnings;
}

}  // namespace opaline
