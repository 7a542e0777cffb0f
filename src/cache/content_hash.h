// SPDX-License-Identifier: GPL-3.0-or-later
// XXH3 over a stream of bytes: some 10 GB/s per core, faster than any disk of a cache.
#pragma once

#include <cstddef>

#include "cache/stage_key.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace opaline {

class ContentHash {
 public:
  ContentHash() { XXH3_128bits_reset(&state_); }
  void add(const void* bytes, std::size_t size) { XXH3_128bits_update(&state_, bytes, size); }
  StageKey value() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return {hash.high64, hash.low64};
  }

 private:
  XXH3_state_t state_;
};

}  // namespace opaline
