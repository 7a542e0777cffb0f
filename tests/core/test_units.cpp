// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities as people read them.
#include <gtest/gtest.h>

#include "core/units.h"

namespace opaline {
namespace {

// Claim: percentages have two digits, and whole numbers from 100 on. Source: units.h. Fails if: 100 % is printed as 1e+02 %.
TEST(Units, PercentagesAreNumbersWithoutExponents) {
  EXPECT_EQ(short_percent(.0025), "0.25 %");
  EXPECT_EQ(short_percent(.123), "12 %");
  EXPECT_EQ(short_percent(.994), "99 %");
  EXPECT_EQ(short_percent(.996), "100 %");
  EXPECT_EQ(short_percent(1), "100 %");
  EXPECT_EQ(short_percent(14.2), "1420 %");
}

}  // namespace
}  // namespace opaline
