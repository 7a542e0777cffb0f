// SPDX-License-Identifier: GPL-3.0-or-later
// Division of the work on one image among processes.
#pragma once

#include <cstddef>

namespace opaline {

inline constexpr std::size_t kMostParts = 4096;

/// One of several parts of about equal work.
struct ImagePart {
  std::size_t number = 1;  ///< from 1 to count
  std::size_t count = 1;
};

}  // namespace opaline
