// SPDX-License-Identifier: GPL-3.0-or-later
// File of random-walk sums.
#pragma once

#include <map>
#include <string>

#include "cache/stage_key.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Sums by key of their light source (stage_keys.h).
using WalkFile = std::map<StageKey, SourceSums>;

/// Writes an EXR of 32-bit sums.
/// error Error{run_failed} naming the file: not writable, disk full; the old file remains unchanged
void write_walks(const std::string& path, const WalkFile& walks);

/// Sums in the file; none without a file.
/// error Error{bad_input} naming the file: damaged, not such sums
WalkFile read_walks(const std::string& path);

}  // namespace opaline
