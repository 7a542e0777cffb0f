// SPDX-License-Identifier: GPL-3.0-or-later
// The sums of a direct rendering, from one run to the next.
#pragma once

#include <chrono>
#include <string>

#include "cli/arguments.h"
#include "methods/direct/direct.h"
#include "opaline/error.h"
#include "session/scene_hash.h"

namespace opaline {

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
