// SPDX-License-Identifier: GPL-3.0-or-later
// HTTP and WebSocket clients of servers on this machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace opaline::test {

/// TCP connection to a port of this machine, closed at the end of its life.
class Connection {
 public:
  /// error std::runtime_error where nothing listens there
  explicit Connection(std::uint16_t port);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Writes bytes; a server that has closed the connection is no error.
  void write(const std::string& bytes);
  /// Reads bytes until the server closes, or until there are as many.
  std::string read(std::size_t most);

 private:
  int socket_;
};

/// Listener on a free port of this machine.
class Listener {
 public:
  Listener();
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  std::uint16_t port() const { return port_; }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

struct HttpRequest {
  std::string method = "GET", target;
  std::string headers;  ///< whole lines, each ended by \r\n
  std::string body;
};
/// Status of the answer to a request.
int http_status(std::uint16_t port, const HttpRequest& request);

struct WebSocketDeclined : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Client of a WebSocket (RFC 6455).
class WebSocket {
 public:
  struct Message {
    bool is_text = false;
    std::string bytes;
  };

  /// receive_buffer: bytes that wait unread before the server notices; 0: the system's default
  /// error WebSocketDeclined where the server refuses the handshake; std::runtime_error where nothing listens
  WebSocket(std::uint16_t port, const std::string& host, const std::string& path, const std::string& origin,
            int receive_buffer = 0);
  ~WebSocket();

  void send_text(const std::string& text);
  void send_binary(const std::string& bytes);
  /// Writes bytes beneath the protocol.
  void write_raw(const std::string& bytes);
  /// Next message; none where none comes within the time, after which reading may go on, or where the server closed.
  std::optional<Message> read_within(std::chrono::milliseconds time);
  void close();
  /// Reason that the server gave for closing, as RFC 6455, 7.4.1; 0: none.
  unsigned close_code() const;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace opaline::test
