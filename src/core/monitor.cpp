// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/monitor.h"

#include "opaline/error.h"

namespace opaline {

void advance(Monitor* monitor, std::size_t work) {
  if (monitor == nullptr) return;
  monitor->done += work;
  if (monitor->cancelled) throw Error(ErrorKind::interrupted, {}, 0, 0, "interrupted");
}

}  // namespace opaline
