// SPDX-License-Identifier: GPL-3.0-or-later
// Machine and build of a benchmark.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace opaline {

/// version, commit, program (its hash), date, cpu, cores, load (of the last minute, before the benchmark),
/// system, compiler, build.
std::vector<std::pair<std::string, std::string>> machine_notes();

/// Hash of the running executable; hexadecimal.
const std::string& program_hash();

}  // namespace opaline
