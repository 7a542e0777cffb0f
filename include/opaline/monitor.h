// SPDX-License-Identifier: GPL-3.0-or-later
// Communication of a long stage with its caller: progress and cancellation. The library never prints.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace opaline {

struct Image;

/// Work counters of one stage, shared by its threads; polled by a progress display.
struct Monitor {
  std::atomic<const char*> stage{nullptr};  ///< current stage, a literal; null: chosen by the caller
  std::atomic<std::size_t> done{0};
  std::atomic<std::size_t> total{0};  ///< 0: unknown; may change during the work if it is an estimate
  std::atomic<double> noise{-1};      ///< relative standard error so far, of random work; below 0: unknown
  std::atomic<unsigned> rounds{0};    ///< counting rounds; `done` starts at 0 in each
  std::atomic<bool> cancelled{false};
  /// Called during the shading of an image, by one of its threads, with a copy of the image: pixels are final if
  /// is_final is 1, otherwise 0. Set it before the work begins.
  std::function<void(Image&& image, const std::vector<std::uint8_t>& is_final)> show_partial = {};
  double partial_interval = 1;  ///< least time between these calls, s

  /// Starts a stage. work: in units of the stage's choice; progress counts up to it.
  void begin(const char* name, std::size_t work) {
    stage = name;
    done = 0;
    total = work;
    noise = -1;
    ++rounds;
  }
};

/// Counts finished work and throws Error{interrupted} after cancellation; no effect for a null monitor.
void advance(Monitor* monitor, std::size_t work);

}  // namespace opaline
