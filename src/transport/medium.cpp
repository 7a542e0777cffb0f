// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/medium.h"

#include <fmt/format.h>

#include <cmath>

#include "opaline/error.h"

namespace opaline {

void check_value(bool is_good, const char* name, const char* expected, double value) {
  if (is_good) return;
  throw Error(ErrorKind::bad_input, {}, 0, 0, fmt::format("'{}' is out of range", name), expected,
              fmt::format("{}", value));
}

void check_medium(const HomogeneousMedium& medium) {
  const auto coefficient = [](const char* name, double value) {
    check_value(value >= 0 && value <= 1e30, name, "a number from 0 to 1e30", value);
  };
  coefficient("sigma_a", medium.sigma_a);
  coefficient("sigma_s", medium.sigma_s);
  check_value(std::abs(medium.g) < 1, "g", "a number between -1 and 1", medium.g);
  check_value(medium.eta >= .1 && medium.eta <= 10, "eta", "a number from 0.1 to 10", medium.eta);
}

}  // namespace opaline
