// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of undo.
#include <gtest/gtest.h>
#include <malloc.h>

#include <string>

#include "view/edit_history.h"

namespace opaline {
namespace {

// Claim: a thousand steps are kept, each with its edits, in a fraction of the memory of copies of all. Source: counted, 133 bytes an
// edit in a copy. Tolerance: a quarter. Fails if: each step has texts of its own.
TEST(EditHistory, StepsShareTheirTexts) {
  constexpr std::size_t kSteps = 1000, kEdits = 200;
  const std::string tail(100, '1');
  EditHistory history;
  EditHistory::Edits edits(kEdits);
  for (std::size_t i = 0; i < kEdits; ++i) edits[i] = std::to_string(i) + '=' + tail;
  const std::size_t before = mallinfo2().uordblks;
  for (std::size_t step = 0; step < kSteps + 5; ++step) {
    edits[step % kEdits] = std::to_string(step) + '=' + tail;
    history.push(edits);
  }
  EXPECT_LT(double(mallinfo2().uordblks) - double(before), .25 * 133 * double(kSteps * kEdits));
  EXPECT_EQ(history.edits(), edits);
  EXPECT_EQ(history.place(), kSteps - 1);
  EXPECT_EQ(history.edits_at(0)[5], "5=" + tail);
  history.go_to(kSteps - 2);
  EXPECT_EQ(history.edits()[(kSteps + 4) % kEdits], std::to_string(kSteps + 4 - kEdits) + '=' + tail);
  history.push({});
  EXPECT_FALSE(history.can_redo());
}

}  // namespace
}  // namespace opaline
