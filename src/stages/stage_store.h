// SPDX-License-Identifier: GPL-3.0-or-later
// Stage results: reused, read from the disk cache, or computed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "stages/session_work.h"
#include "stages/stage_cache.h"

namespace opaline {

/// A stage's result with the key of its inputs; a key of zeros: no result.
template <class T>
struct StageResult {
  StageKey key;
  T value{};
};

enum class ResultSource { reused, cache, computed };

/// Provides stage results by key. A result has its key only once it is complete: an interrupted computation
/// leaves none.
class StageStore {
 public:
  /// cache: null: no disk cache
  StageStore(StageCache* cache, SessionWork& work, std::vector<std::string>& decisions)
      : cache_(cache), work_(work), decisions_(decisions) {}

  /// Updates a result: reuses it, reads it from the cache, or computes and caches it.
  template <class Codec, class Compute>
  ResultSource get(StageResult<typename Codec::Value>& result, const StageKey& key, const Codec& codec,
                   const Compute& compute) {
    if (result.key == key) return ResultSource::reused;
    result.key = {};
    ResultSource source = ResultSource::cache;
    if (auto found = find(key, codec)) {
      result.value = std::move(*found);
    } else {
      result.value = compute();
      keep(key, result.value, codec);
      source = ResultSource::computed;
    }
    result.key = key;
    return source;
  }

  /// The same without a disk cache.
  template <class T, class Compute>
  ResultSource get(StageResult<T>& result, const StageKey& key, const Compute& compute) {
    if (result.key == key) return ResultSource::reused;
    result.key = {};
    result.value = compute();
    result.key = key;
    return ResultSource::computed;
  }

  template <class Codec>
  std::optional<typename Codec::Value> find(const StageKey& key, const Codec& codec) {
    if (cache_ == nullptr) return {};
    auto found = cache_->find(key, codec);
    work_.found += found ? 1 : 0;
    return found;
  }
  template <class Codec>
  void keep(const StageKey& key, const typename Codec::Value& value, const Codec& codec) {
    if (cache_ != nullptr) cache_->keep(key, value, codec);
  }
  bool has_cache() const { return cache_ != nullptr; }

  /// Reports a decision about a body, once in a row.
  void note(const std::string& body, const std::string& text) {
    std::string decision = body + ": " + text;
    if (decisions_.empty() || decisions_.back() != decision) decisions_.push_back(std::move(decision));
  }
  /// Reports where a result came from: "tree reused", "tree from the cache", "tree built".
  void note(const std::string& body, const std::string& result, ResultSource source, const char* computed) {
    constexpr const char* kSources[]{"reused", "from the cache"};
    note(body, result + ' ' +
                   (source == ResultSource::computed ? computed : kSources[source == ResultSource::cache]));
  }

  SessionWork& work() { return work_; }

 private:
  StageCache* cache_;
  SessionWork& work_;
  std::vector<std::string>& decisions_;
};

}  // namespace opaline
