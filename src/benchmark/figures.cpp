// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opaline {

std::string figure(double value) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{}", value);
  const int places = 2 - int(std::floor(std::log10(std::abs(value))));
  return fmt::format("{:.{}f}", value, std::clamp(places, 0, 4));
}

}  // namespace opaline
