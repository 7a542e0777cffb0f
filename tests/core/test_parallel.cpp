// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <tbb/task.h>

#include <stdexcept>
#include <vector>

#include "core/parallel.h"

namespace opaline {
namespace {

// Claim: a loop within a loop that has been given up runs all its bodies. Source: parallel.h. Fails if: the inner loop
// shares the outer one's context, whose end it then takes for its own; what follows it reads results that were never
// written.
TEST(Parallel, ALoopWithinOneThatEndsIsWhole) {
  std::vector<int> ran(1000);
  const auto outer = [&](std::size_t, std::size_t, std::size_t) {
    tbb::task::current_context()->cancel_group_execution();  // as when another body throws
    parallel_chunks(ran.size(), 10, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) ran[i] = 1;
    });
  };
  parallel_chunks(1, 1, outer);
  EXPECT_EQ(ran, std::vector<int>(1000, 1));
}

// Claim: what a body throws reaches the caller, through a loop within a loop too.
TEST(Parallel, ThrowsWhatABodyThrows) {
  const auto inner = [](std::size_t, std::size_t, std::size_t chunk) {
    if (chunk == 3) throw std::runtime_error("three");
  };
  EXPECT_THROW(
      parallel_chunks(4, 1, [&](std::size_t, std::size_t, std::size_t) { parallel_chunks(8, 1, inner); }),
      std::runtime_error);
}

}  // namespace
}  // namespace opaline
