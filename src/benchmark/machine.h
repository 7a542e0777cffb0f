// SPDX-License-Identifier: GPL-3.0-or-later
// Where and with what a benchmark ran.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace opaline {

/// version, commit, program (its hash), date, cpu, cores, load (of the last minute, before the benchmark),
/// system, compiler, build.
std::vector<std::pair<std::string, std::string>> machine_notes();

/// Program hash of the bytes of the executable that runs; hexadecimal.
std::string program_hash();

}  // namespace opaline
