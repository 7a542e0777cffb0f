// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume/cell_warnings.h"

#include <fmt/format.h>

namespace opaline {

std::vector<std::string> cell_warnings(const Body& body, const VolumeExitance& exitance) {
  constexpr double kMuch = 1e-3;  // fraction of the transmitted light
  std::vector<std::string> warnings;
  if (const double lost = max_component(exitance.lost); lost > kMuch)
    warnings.push_back(
        fmt::format("{}: {:.2g} % of the transmitted light leaks through holes in the meshes and is lost; "
                    "close them (fill_holes)",
                    body.plan.name, 100 * lost));
  if (const double stopped = max_component(exitance.stopped); stopped > kMuch)
    warnings.push_back(
        fmt::format("{}: {:.2g} % of the transmitted light ends at other shapes inside the body; move the "
                    "shapes apart, or put shapes of one medium into one group",
                    body.plan.name, 100 * stopped));
  if (!exitance.outer_shares.empty())
    warnings.push_back(fmt::format(
        "{}: parts of the surface lie inside the body; random walks pass through them", body.plan.name));
  return warnings;
}

}  // namespace opaline
