// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of a direct rendering and of random walks, stored between runs.
#pragma once

#include <chrono>
#include <string>

#include "cli/arguments.h"
#include "methods/direct/direct.h"
#include "opaline/error.h"
#include "opaline/session.h"
#include "session/scene_hash.h"
#include "session/walk_file.h"

namespace opaline {

/// Sums of all bodies and lights in the --resume file, if there is one. They do not depend on the camera or
/// on colours.
class ResumableWalks {
 public:
  /// Random walks of the session read and update the file's sums during this object's lifetime.
  ResumableWalks(const std::string& path, Session& session) : path_(path), session_(session) {
    if (path_.empty()) return;
    walks_ = read_walks(path_);
    was_empty_ = walks_.empty();
    session_.store_walks(
        {[this](const StageKey& key) { return find(key); },
         [this](std::span<const StageKey> keys, const VolumeSums& sums) { keep(keys, sums); }});
  }
  ~ResumableWalks() { session_.store_walks({}); }
  ResumableWalks(const ResumableWalks&) = delete;
  ResumableWalks& operator=(const ResumableWalks&) = delete;

  void write() {
    if (path_.empty() || !changed_) return;
    write_walks(path_, walks_);
    changed_ = false;
    last_ = std::chrono::steady_clock::now();
  }

  /// Passes over the samples, of all channels and lights.
  std::size_t passes() const {
    std::size_t sum = 0;
    for (const auto& [key, source] : walks_)
      for (const WalkSums& channel : source.channels) sum += channel.passes;
    return sum;
  }

 private:
  std::optional<SourceSums> find(const StageKey& key) {
    const auto found = walks_.find(key);
    if (found == walks_.end()) return {};
    has_found_ = true;
    return found->second;
  }

  // The scene may have a new light or body, but not only new ones.
  void keep(std::span<const StageKey> keys, const VolumeSums& sums) {
    if (!was_empty_ && !has_found_)
      throw bad_file(path_, "the sums belong to another scene or other settings",
                     "the sums of this scene and settings, or a new file name");
    const std::size_t before = passes();
    for (std::size_t s = 0; s < keys.size(); ++s) walks_[keys[s]] = sums.sources[s];
    changed_ = changed_ || passes() != before;
    if (std::chrono::steady_clock::now() - last_ > std::chrono::minutes(1)) write();
  }

  std::string path_;
  Session& session_;
  WalkFile walks_;
  bool was_empty_ = true, has_found_ = false, changed_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Sums kept in the --resume file, if there is one.
class ResumableState {
 public:
  ResumableState(const RenderArguments& arguments, const Scene& scene)
      : path_(arguments.resume), scene_(scene) {
    if (path_.empty()) return;
    key_ = direct_sums_key(arguments.scene, arguments.overrides, scene_);
    if (key_.empty())
      throw bad_file(path_, "cannot store the sums of a scene that is read from a pipe", "a scene in a file");
    state = read_direct_state(path_, scene_, key_);
    written_ = state.passes;
  }

  void keep_each_minute() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::minutes(1)) return;
    keep();
    last_ = now;
  }

  void keep() {
    if (path_.empty() || state.passes == written_) return;
    write_direct_state(path_, state, scene_, key_);
    written_ = state.passes;
  }

  DirectState state;

 private:
  std::string path_, key_;
  const Scene& scene_;
  std::size_t written_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace opaline
