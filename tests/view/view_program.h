// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline view` as a child process, and pages of it.
#pragma once

#include "../cli/run_program.h"
#include "view_client.h"

namespace opaline::test {

/// One that was free a moment ago.
inline std::uint16_t free_port() {
  asio::io_context io;
  return Tcp::acceptor(io, Tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0)).local_endpoint().port();
}

inline ViewClient page_of(std::uint16_t port) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  return ViewClient({asio::ip::make_address("127.0.0.1"), port}, host, "/" + std::string(kToken) + "/socket",
                    "http://" + host);
}

}  // namespace opaline::test
