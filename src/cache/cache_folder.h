// SPDX-License-Identifier: GPL-3.0-or-later
// Cache entries as files: listing, integrity, and eviction.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cache/stage_key.h"

namespace opaline {

struct CacheEntry {
  std::string file;   ///< its name in the folder
  std::string stage;  ///< "samples", "light", "octree" or "exitance"
  StageKey key;
  std::uint64_t bytes = 0;                    ///< 0 for an entry's name without a regular file
  std::filesystem::file_time_type last_used;  ///< written or read
};

/// All entries, the least recently used first; ignores other files in the folder.
/// error Error{run_failed} naming the folder: it cannot be read
std::vector<CacheEntry> list_cache(const std::string& folder);

/// Reads a whole entry in pieces; returns the reason it is unusable ("is truncated"), or an empty text. Does
/// not check its plausibility, which needs the scene.
std::string problem_of(const std::string& folder, const CacheEntry& entry);

/// Removes the least recently used entries down to this many bytes, and temporary files of writers killed
/// more than an hour ago. One process at a time; readers and writers continue. Keeps folders.
/// in    wait: called every 10 ms while another process has the lock: false gives up, removing nothing; none:
///       waits indefinitely
/// out   the removed entries
/// error Error{run_failed} naming the folder or file
std::vector<CacheEntry> prune_cache(const std::string& folder, std::uint64_t most_bytes,
                                    const std::function<bool()>& wait = {});

}  // namespace opaline
