// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures under way on the screen of tev, a viewer that listens on a TCP port.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "core/log.h"
#include "opaline/image/image.h"
#include "opaline/render/render.h"

namespace opaline {

struct ServerAddress {
  std::string host, port;
};

/// "host", "host:port", "[::1]:port"; tev's own port 14158 where none is given; nothing if it is neither.
std::optional<ServerAddress> parse_server_address(std::string_view text);

/// One connection. A viewer that is not there, goes away, takes nothing for two seconds or keeps the program
/// waiting for more than five seconds and a quarter of the time in all is named in one warning, and nothing
/// is sent any more. Pictures: R G B A in float, as tev's CreateImage and UpdateImage (its version 3) have
/// them; names tell them apart there.
class DisplayServer {
 public:
  DisplayServer(const ServerAddress& address, const Log& log);
  ~DisplayServer();
  DisplayServer(const DisplayServer&) = delete;
  DisplayServer& operator=(const DisplayServer&) = delete;

  bool is_connected() const { return socket_ >= 0; }

  /// A black picture of the image's size, in place of what had its name.
  void create(const std::string& name, const Image& image);
  /// Pixels of the part; image: its first channels are R G B A.
  void update(const std::string& name, const Image& image, const Rectangle& part);

 private:
  void connect(const ServerAddress& address);
  void send(std::string packet);
  bool is_too_slow() const;
  void give_up(const std::string& why);

  std::string address_;
  Log log_;
  int socket_ = -1;
  using Clock = std::chrono::steady_clock;
  Clock::time_point connected_;
  std::chrono::duration<double> waited_{0};  // in all sends
};

}  // namespace opaline
