// SPDX-License-Identifier: GPL-3.0-or-later
// Memory available to this process.
#pragma once

#include <cstddef>
#include <string>

namespace opaline {

/// Bytes available to this process before a limit: minimum of the kernel's available memory (MemAvailable,
/// without free swap), the remaining limits of the process's control groups (version 1 and 2; droppable file
/// pages count as free), and the remaining address space of RLIMIT_AS and RLIMIT_DATA. The largest size_t if
/// unknown.
/// in    root: folder with proc and sys, for tests
std::size_t available_memory(const std::string& root = "");

/// Current resident set of this process, bytes; 0 without /proc.
std::size_t resident_memory();

}  // namespace opaline
