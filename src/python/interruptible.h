// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <future>

#include "opaline/error.h"
#include "opaline/monitor.h"

namespace opaline {

/// Runs work on another thread without Python's lock. Ctrl-C cancels it and becomes a KeyboardInterrupt.
template <class Work>
auto interruptible(const Work& work) {
  Monitor monitor;
  auto result = std::async(std::launch::async, [&] { return work(monitor); });
  bool is_interrupted = false;
  for (bool is_done = false; !is_done;) {
    {
      const nanobind::gil_scoped_release unlocked;
      is_done = result.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready;
    }
    if (!is_interrupted && PyErr_CheckSignals() != 0) {
      is_interrupted = true;
      monitor.cancelled = true;
    }
  }
  if (is_interrupted) {
    try {
      result.get();
    } catch (const Error&) {
    }
    throw nanobind::python_error();
  }
  return result.get();
}

}  // namespace opaline
