// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <csignal>

#include "core/interrupt.h"

namespace opaline {
namespace {

// Claim: a signal is told to the work at hand, and where that ends without minding it to the work around, as a range of
// frames is around a frame. Fails if a signal in a frame's last moments is lost.
TEST(Interrupt, ComesThroughToTheWorkAround) {
  Monitor range;
  const InterruptHandler around(range);
  {
    Monitor frame;
    const InterruptHandler interrupt(frame);
    std::raise(SIGINT);
    EXPECT_TRUE(frame.cancelled);
    EXPECT_FALSE(range.cancelled);
  }
  EXPECT_TRUE(range.cancelled);
}

// Claim: after work that no signal met, the next one is told to the work around. Fails if the handler before is forgotten.
TEST(Interrupt, IsToldToTheWorkAroundAfterwards) {
  Monitor range;
  const InterruptHandler around(range);
  {
    Monitor frame;
    const InterruptHandler interrupt(frame);
  }
  EXPECT_FALSE(range.cancelled);
  std::raise(SIGINT);
  EXPECT_TRUE(range.cancelled);
}

}  // namespace
}  // namespace opaline
