// SPDX-License-Identifier: GPL-3.0-or-later
// The sums of random walks in a file.
#pragma once

#include <map>
#include <string>

#include "cache/stage_key.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// By the keys of their sources of light (stage_keys.h).
using WalkFile = std::map<StageKey, SourceSums>;

/// Writes an EXR of 32-bit sums.
/// error Error{run_failed} naming the file: not writable, disk full; the old file is left as it was
void write_walks(const std::string& path, const WalkFile& walks);

/// The sums in the file; none where there is no file.
/// error Error{bad_input} naming the file: damaged, not such sums
WalkFile read_walks(const std::string& path);

}  // namespace opaline
