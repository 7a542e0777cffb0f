// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline view` as a child process, and pages of it.
#pragma once

#include "../cli/run_program.h"
#include "view_client.h"

namespace opaline::test {

/// One that was free a moment ago.
inline std::uint16_t free_port() {
  return Listener().port();
}

inline ViewClient page_of(std::uint16_t port) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  return ViewClient(port, host, "/" + std::string(kToken) + "/socket", "http://" + host);
}

}  // namespace opaline::test
