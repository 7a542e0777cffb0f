// SPDX-License-Identifier: GPL-3.0-or-later
// Disk cache of the pipeline's stage results, addressed by the key of their inputs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cache/blob_cache.h"

namespace opaline {

/// Stage results in a cache folder. A codec (stages/stage_codecs.h) names the stage, bounds the size of its
/// entry, and checks everything it reads: no entry, even a forged one, uses more memory than its result could
/// need, or breaks a later stage.
class StageCache {
 public:
  /// error Error{run_failed} naming the folder: missing, and cannot be created
  explicit StageCache(std::string folder, std::uint64_t most_bytes = BlobCache::kDefaultBytes)
      : blobs_(std::move(folder), most_bytes) {}

  /// The cached result; none: no entry, or an unusable one.
  template <class Codec>
  std::optional<typename Codec::Value> find(const StageKey& key, const Codec& codec) {
    const std::optional<BlobReader> entry = blobs_.find(Codec::kStage, key, codec.most_bytes());
    if (!entry) return {};
    std::optional<typename Codec::Value> result = codec.get(*entry);
    if (!result) blobs_.reject(Codec::kStage, key);
    return result;
  }

  /// Writes a result. Failures appear in warning().
  template <class Codec>
  void keep(const StageKey& key, const typename Codec::Value& value, const Codec& codec) {
    blobs_.keep(Codec::kStage, key, [&](BlobWriter& file) { codec.put(file, value); });
  }

  /// One line naming each unusable entry, and the reason for a result not written; empty: no failures.
  std::string warning() const { return blobs_.warning(); }

 private:
  BlobCache blobs_;
};

}  // namespace opaline
