// SPDX-License-Identifier: GPL-3.0-or-later
// Results on the disk, by the hash of their inputs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cache/blobs.h"
#include "cache/stage_key.h"

namespace opaline {

/// A folder of entries, HDF5 files that any number of processes fill and read at once: an entry appears whole
/// under its key or not at all, and is checked whole before anyone looks into it. Nothing here fails a run:
/// what cannot be used is computed again, what cannot be kept is not.
class BlobCache {
 public:
  static constexpr std::uint64_t kDefaultBytes = std::uint64_t(8) << 30;

  /// Makes the folder. most_bytes: beyond it the least recently used entries go.
  /// error Error{run_failed} naming the folder: there is none and none can be made
  explicit BlobCache(std::string folder, std::uint64_t most_bytes = kDefaultBytes);

  /// The entry of a key, or nothing.
  /// in    stage: lower-case letters, the first part of the entry's file name
  ///       most_bytes: what the result can need; a larger file is not read
  std::optional<BlobReader> find(const char* stage, const StageKey& key, std::uint64_t most_bytes);
  /// Reports an entry that was found, but holds something that its key cannot stand for.
  void reject(const char* stage, const StageKey& key);

  /// Writes an entry and makes room for it. Failures are kept for warning().
  /// in    fill: puts the entry's arrays; called at most once
  void keep(const char* stage, const StageKey& key, const std::function<void(BlobWriter&)>& fill);

  /// One line that names every entry that could not be used and why something was not kept; empty: all well.
  std::string warning() const;

 private:
  void prune();

  std::string folder_;
  std::uint64_t most_bytes_;
  std::vector<std::string> unusable_, too_large_;
  std::string not_kept_;    // why; then nothing more is tried
  bool is_locked_ = false;  // by another process, for too long to wait
};

}  // namespace opaline
