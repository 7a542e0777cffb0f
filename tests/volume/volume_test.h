// SPDX-License-Identifier: GPL-3.0-or-later
// Walked values against what is known.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "transport/laboratory.h"

namespace opaline::test {

/// Within four standard errors, which are themselves at most `largest_error`: a wide error bar proves nothing.
inline void expect_walked(const WalkedValue& walked, double truth, double largest_error,
                          const std::string& what) {
  EXPECT_NEAR(walked.value, truth, 4 * walked.error + 1e-12) << what;
  EXPECT_LE(walked.error, largest_error) << what;
}

/// sigma_t = 1: lengths are mean free paths.
inline HomogeneousMedium medium_of_albedo(double albedo, double eta = 1, double g = 0) {
  return {1 - albedo, albedo, g, eta};
}

inline LaboratorySettings walks_of_seed(std::size_t walks, std::uint64_t seed) {
  LaboratorySettings settings;
  settings.walks = walks;
  settings.seed = seed;
  return settings;
}

}  // namespace opaline::test
