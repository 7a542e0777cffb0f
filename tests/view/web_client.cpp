// SPDX-License-Identifier: GPL-3.0-or-later
// Boost.Beast takes longer to compile than all that uses it: here alone.
#include "web_client.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

namespace opaline::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

sockaddr_in address_of(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int new_socket() {
  const int made = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (made < 0) throw std::runtime_error("no socket");
  return made;
}

}  // namespace

Connection::Connection(std::uint16_t port) : socket_(new_socket()) {
  const sockaddr_in address = address_of(port);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
  ::close(socket_);
  throw std::runtime_error("nothing listens at port " + std::to_string(port));
}

Connection::~Connection() {
  ::close(socket_);
}

void Connection::write(const std::string& bytes) {
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t n = ::send(socket_, bytes.data() + written, bytes.size() - written, MSG_NOSIGNAL);
    if (n <= 0) return;
    written += std::size_t(n);
  }
}

std::string Connection::read(std::size_t most) {
  std::string bytes(most, '\0');
  std::size_t read = 0;
  while (read < most) {
    const ssize_t n = ::recv(socket_, bytes.data() + read, most - read, 0);
    if (n <= 0) break;
    read += std::size_t(n);
  }
  return bytes.substr(0, read);
}

Listener::Listener() : socket_(new_socket()) {
  sockaddr_in address = address_of(0);
  socklen_t size = sizeof address;
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || ::listen(socket_, 1) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no free port");
  port_ = ntohs(address.sin_port);
}

Listener::~Listener() {
  ::close(socket_);
}

int http_status(std::uint16_t port, const HttpRequest& request) {
  Connection line(port);
  line.write(request.method + " " + request.target + " HTTP/1.1\r\n" + request.headers + "\r\n" +
             request.body);
  const std::string status = line.read(12);  // "HTTP/1.1 200"
  if (status.size() < 12 || !status.starts_with("HTTP/1.1 "))
    throw std::runtime_error("no answer: " + status);
  return std::stoi(status.substr(9));
}

struct WebSocket::Stream {
  asio::io_context io;
  beast::websocket::stream<beast::tcp_stream> socket{io};
  beast::flat_buffer in;
  std::optional<beast::error_code> result;
  bool is_reading = false;
};

WebSocket::WebSocket(std::uint16_t port, const std::string& host, const std::string& path,
                     const std::string& origin, int receive_buffer)
    : stream_(std::make_unique<Stream>()) {
  auto& socket = stream_->socket;
  socket.read_message_max(0);
  const asio::ip::tcp::endpoint endpoint(asio::ip::make_address("127.0.0.1"), port);
  asio::ip::tcp::socket& line = beast::get_lowest_layer(socket).socket();
  line.open(endpoint.protocol());
  if (receive_buffer > 0) line.set_option(asio::socket_base::receive_buffer_size(receive_buffer));
  beast::get_lowest_layer(socket).connect(endpoint);
  socket.set_option(beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
    if (!origin.empty()) request.set(beast::http::field::origin, origin);
  }));
  beast::error_code error;
  socket.handshake(host, path, error);
  if (error == beast::websocket::error::upgrade_declined) throw WebSocketDeclined("declined: " + path);
  if (error) throw std::runtime_error("no WebSocket: " + error.message());
}

WebSocket::~WebSocket() = default;

void WebSocket::send_text(const std::string& text) {
  stream_->socket.text(true);
  stream_->socket.write(asio::buffer(text));
}

void WebSocket::send_binary(const std::string& bytes) {
  stream_->socket.binary(true);
  stream_->socket.write(asio::buffer(bytes));
}

void WebSocket::write_raw(const std::string& bytes) {
  asio::write(beast::get_lowest_layer(stream_->socket).socket(), asio::buffer(bytes));
}

std::optional<WebSocket::Message> WebSocket::read_within(std::chrono::milliseconds time) {
  Stream& s = *stream_;
  if (!s.is_reading) {
    s.is_reading = true;
    s.result.reset();
    s.socket.async_read(s.in, [&s](beast::error_code error, std::size_t) {
      s.result = error;
      s.is_reading = false;
    });
  }
  s.io.restart();
  s.io.run_one_for(std::chrono::milliseconds(0));
  const auto end = std::chrono::steady_clock::now() + time;
  while (!s.result && std::chrono::steady_clock::now() < end) s.io.run_one_until(end);
  if (!s.result || *s.result) return std::nullopt;
  Message message{s.socket.got_text(), beast::buffers_to_string(s.in.data())};
  s.in.consume(s.in.size());
  s.result.reset();
  return message;
}

void WebSocket::close() {
  beast::get_lowest_layer(stream_->socket).close();
  stream_->io.restart();
  stream_->io.run();
}

unsigned WebSocket::close_code() const {
  return stream_->socket.reason().code;
}

}  // namespace opaline::test
