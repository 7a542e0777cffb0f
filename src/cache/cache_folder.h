// SPDX-License-Identifier: GPL-3.0-or-later
// Cache entries as files: list, integrity, and eviction order.
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
  std::uint64_t bytes = 0;                    ///< 0 for what has an entry's name and is no regular file
  std::filesystem::file_time_type last_used;  ///< written or read
};

/// All entries, the least recently used first; other files in the folder are not looked at.
/// error Error{run_failed} naming the folder: it cannot be read
std::vector<CacheEntry> list_cache(const std::string& folder);

/// Reads an entry whole, piece by piece; empty, or why it cannot be used: "is truncated". Whether it holds
/// what its key stands for only those who have the scene can tell.
std::string problem_of(const std::string& folder, const CacheEntry& entry);

/// Removes the least recently used entries until the rest has at most this many bytes, and what writers that
/// were killed more than an hour ago left behind. One process at a time; readers and writers go on meanwhile.
/// Folders stay.
/// in    wait: asked every 10 ms while another process holds the lock: false gives up, and
/// nothing is removed; none:
///       waits as long as it takes
/// out   the entries removed
/// error Error{run_failed} naming the folder or file
std::vector<CacheEntry> prune_cache(const std::string& folder, std::uint64_t most_bytes,
                                    const std::function<bool()>& wait = {});

}  // namespace opaline
