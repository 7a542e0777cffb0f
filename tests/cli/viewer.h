// SPDX-License-Identifier: GPL-3.0-or-later
// A viewer on a port of this machine that understands what tev does of its protocol.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace opaline {

/// Reads the fields of a packet one after the other.
struct PacketReader {
  std::string bytes;
  std::size_t at = 0;

  template <class T>
  T take() {
    T value{};
    if (at + sizeof value > bytes.size()) throw std::runtime_error("packet too short");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }
  std::string take_text() {
    const std::size_t end = bytes.find('\0', at);
    if (end == std::string::npos) throw std::runtime_error("text without an end");
    const std::string text = bytes.substr(at, end - at);
    at = end + 1;
    return text;
  }
  std::vector<std::string> take_texts(std::int32_t count) {
    std::vector<std::string> texts;
    for (std::int32_t i = 0; i < count; ++i) texts.push_back(take_text());
    return texts;
  }
};

/// A picture as the viewer has it, R G B A a pixel, and how it came about.
struct ShownPicture {
  int width = 0, height = 0;
  std::vector<float> pixels;
  std::vector<std::vector<float>> whole;  ///< after each update of all of it
  int creations = 0, tiles = 0;           ///< updates of a part
};

/// The pictures after all packets of the stream.
/// error std::runtime_error: not the protocol
inline std::map<std::string, ShownPicture> shown_by(const std::string& stream) {
  std::map<std::string, ShownPicture> pictures;
  const std::vector<std::string> channels{"R", "G", "B", "A"};
  for (std::size_t at = 0; at < stream.size();) {
    const auto length = PacketReader{stream.substr(at, 4)}.take<std::uint32_t>();
    if (length < 5 || at + length > stream.size()) throw std::runtime_error("a packet's length");
    PacketReader packet{stream.substr(at + 4, length - 4)};
    at += length;
    const auto type = packet.take<std::uint8_t>();
    const bool grab_focus = packet.take<std::uint8_t>() != 0;
    const std::string name = packet.take_text();
    ShownPicture& picture = pictures[name];
    if (type == 4) {
      picture.width = packet.take<std::int32_t>();
      picture.height = packet.take<std::int32_t>();
      EXPECT_EQ(packet.take_texts(packet.take<std::int32_t>()), channels);
      picture.pixels.assign(std::size_t(4 * picture.width * picture.height), 0);
      ++picture.creations;
    } else if (type == 6) {
      EXPECT_FALSE(grab_focus);
      EXPECT_EQ(packet.take_texts(packet.take<std::int32_t>()), channels);
      const auto x = packet.take<std::int32_t>(), y = packet.take<std::int32_t>(),
                 width = packet.take<std::int32_t>(), height = packet.take<std::int32_t>();
      std::int64_t offsets[4], strides[4];
      for (std::int64_t& offset : offsets) offset = packet.take<std::int64_t>();
      for (std::int64_t& stride : strides) stride = packet.take<std::int64_t>();
      std::vector<float> data((packet.bytes.size() - packet.at) / sizeof(float));
      for (float& value : data) value = packet.take<float>();
      for (std::int32_t row = 0; row < height; ++row)
        for (std::int32_t column = 0; column < width; ++column)
          for (std::size_t c = 0; c < 4; ++c)
            picture.pixels.at(std::size_t((y + row) * picture.width + x + column) * 4 + c) =
                data.at(std::size_t(offsets[c] + (row * width + column) * strides[c]));
      if (width == picture.width && height == picture.height)
        picture.whole.push_back(picture.pixels);
      else
        ++picture.tiles;
    } else {
      throw std::runtime_error("packet of type " + std::to_string(type));
    }
    if (packet.at != packet.bytes.size()) throw std::runtime_error("more in a packet than it says");
  }
  return pictures;
}

/// Listens until it has had one connection.
class Viewer {
 public:
  /// bytes: after as many it closes the connection; pause: after each 400 bytes it reads
  explicit Viewer(std::size_t bytes = SIZE_MAX, std::chrono::milliseconds pause = {})
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)), pause_(pause) {
    const int small = 4096;
    if (pause.count() > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(socket_, 1) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("no port to listen on");
    address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::jthread([this, bytes] { serve(bytes); });
  }
  ~Viewer() {
    leaving_ = true;
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  const std::string& address() const { return address_; }

  /// What it was sent, once the connection has ended.
  std::string stream() {
    thread_.join();
    return stream_;
  }

 private:
  void serve(std::size_t bytes) {
    const int connection = ::accept(socket_, nullptr, nullptr);
    char buffer[4096];
    for (ssize_t n = 1; n > 0 && stream_.size() < bytes && !leaving_;) {
      n = ::read(connection, buffer, pause_.count() > 0 ? 400 : sizeof buffer);
      if (n > 0) stream_.append(buffer, std::size_t(n));
      if (pause_.count() > 0) std::this_thread::sleep_for(pause_);
    }
    if (connection >= 0) ::close(connection);
  }

  int socket_;
  std::chrono::milliseconds pause_;
  std::atomic<bool> leaving_ = false;
  std::string address_, stream_;
  std::jthread thread_;
};

}  // namespace opaline
