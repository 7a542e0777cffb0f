// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/walk_warnings.h"

#include <fmt/format.h>

namespace opaline {

namespace {

constexpr double kLeastLeftOut = 1e-4;  // of the area: above rounding

/// What cells have left out of the area of a body's meshes.
double share_left_out(const Body& body, double unit) {
  if (body.plan.method != Method::volume_diffusion || body.surface.samples.empty()) return 0;
  return 1 - body.surface.area * unit * unit / body.plan.area;
}

}  // namespace

std::vector<std::string> walk_warnings(const Body& body, double unit) {
  constexpr double kMuch = 1e-3;  // of the light that entered
  std::vector<std::string> warnings;
  if (const double left_out = share_left_out(body, unit); left_out > kLeastLeftOut)
    warnings.push_back(fmt::format(
        "{}: {:.2g} % of its surface lies inside of it or is folded; volume_diffusion leaves that out",
        body.plan.name, 100 * left_out));
  if (!body.volume) return warnings;
  if (const double lost = max_component(body.volume->lost); lost > kMuch)
    warnings.push_back(
        fmt::format("{}: {:.2g} % of the light that entered got out through holes of its meshes and is in "
                    "no picture; close them (fill_holes)",
                    body.plan.name, 100 * lost));
  if (const double stopped = max_component(body.volume->stopped); stopped > kMuch)
    warnings.push_back(
        fmt::format("{}: {:.2g} % of the light that entered ended at other shapes inside of it; move them "
                    "apart, or put shapes of one medium into one group",
                    body.plan.name, 100 * stopped));
  if (body.volume->has_inner_sheets)
    warnings.push_back(
        fmt::format("{}: parts of its surface lie inside of it; random walks go through them, and samples "
                    "there are dark",
                    body.plan.name));
  return warnings;
}

}  // namespace opaline
