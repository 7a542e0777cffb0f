// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory the machine has left for this process.
#pragma once

#include <cstddef>
#include <string>

namespace opaline {

/// The bytes that this process may still take before something stops it: the least of what the kernel counts
/// as available (MemAvailable, free swap not counted), what the control groups above the process leave of
/// their limits (version 1 and 2; file pages that the kernel can drop do not count as taken), and what
/// RLIMIT_AS and RLIMIT_DATA leave of the address space. The largest size_t where nothing is known.
/// in    root: the folder that holds proc and sys, for tests
std::size_t available_memory(const std::string& root = "");

/// Resident set of this process now, bytes; 0 where /proc does not say.
std::size_t resident_memory();

}  // namespace opaline
