// SPDX-License-Identifier: GPL-3.0-or-later
// Disk cache of results, by the hash of their inputs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cache/blobs.h"
#include "cache/stage_key.h"

namespace opaline {

/// A folder of entries, HDF5 files shared by any number of processes: an entry appears atomically under its
/// key, and is checked as a whole before use. Failures never fail a run: unusable entries are recomputed, and
/// unwritable ones skipped.
class BlobCache {
 public:
  static constexpr std::uint64_t kDefaultBytes = std::uint64_t(8) << 30;

  /// Creates the folder. most_bytes: maximum cache size; evicts the least recently used entries.
  /// error Error{run_failed} naming the folder: missing, and cannot be created
  explicit BlobCache(std::string folder, std::uint64_t most_bytes = kDefaultBytes);

  /// Entry of a key, or nothing.
  /// in    stage: lower-case letters, the first part of the entry's file name
  ///       most_bytes: upper bound for the result; larger files are not read
  std::optional<BlobReader> find(const char* stage, const StageKey& key, std::uint64_t most_bytes);
  /// Reports an entry with contents implausible for its key.
  void reject(const char* stage, const StageKey& key);

  /// Writes an entry and evicts others if necessary. Failures appear in warning().
  /// in    fill: puts the entry's arrays; called at most once
  void keep(const char* stage, const StageKey& key, const std::function<void(BlobWriter&)>& fill);

  /// One line naming every unusable entry and the reason for an unwritten result; empty: no failures.
  std::string warning() const;

 private:
  void prune();

  std::string folder_;
  std::uint64_t most_bytes_;
  std::vector<std::string> unusable_, too_large_;
  std::string not_kept_;    // reason; then nothing more is written
  bool is_locked_ = false;  // by another process, for too long to wait
};

}  // namespace opaline
