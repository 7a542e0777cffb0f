// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/display_server.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>

namespace opaline {
namespace {

// Numbers are sent as they lie in memory.
static_assert(std::endian::native == std::endian::little);

constexpr int kPatience = 2;  // seconds, for one call of the system's
// Of all sends together: seconds, and a share of the time since the connection was made.
constexpr double kTotalPatience = 5, kShareOfTime = 0.25;
constexpr std::array<std::string_view, 4> kChannels{"R", "G", "B", "A"};
enum class PacketType : std::uint8_t { create_image = 4, update_image = 6 };

template <class T>
void put(std::string& packet, T value) {
  packet.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_text(std::string& packet, std::string_view text) {
  packet.append(text);
  packet += '\0';
}

void put_channel_names(std::string& packet) {
  put(packet, std::int32_t(kChannels.size()));
  for (const std::string_view channel : kChannels) put_text(packet, channel);
}

/// Room for the length, the kind of packet, whether the viewer shows the picture now, and its name.
std::string begin_packet(PacketType type, bool grab_focus, const std::string& name) {
  std::string packet(sizeof(std::uint32_t), '\0');
  put(packet, type);
  put(packet, std::uint8_t(grab_focus));
  put_text(packet, name);
  return packet;
}

/// 0, or why not.
int connect_within(int socket, const addrinfo& address, int seconds) {
  const int flags = ::fcntl(socket, F_GETFL);
  ::fcntl(socket, F_SETFL, flags | O_NONBLOCK);
  if (::connect(socket, address.ai_addr, address.ai_addrlen) != 0) {
    if (errno != EINPROGRESS) return errno;
    pollfd writable{socket, POLLOUT, 0};
    if (::poll(&writable, 1, seconds * 1000) != 1) return ETIMEDOUT;
    int failure = 0;
    socklen_t size = sizeof failure;
    ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &failure, &size);
    if (failure != 0) return failure;
  }
  ::fcntl(socket, F_SETFL, flags);
  const timeval patience{seconds, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  return 0;
}

}  // namespace

std::optional<ServerAddress> parse_server_address(std::string_view text) {
  const std::size_t colon = text.rfind(':'), bracket = text.rfind(']');
  const bool has_port = colon != text.npos && (bracket == text.npos || colon > bracket);
  ServerAddress address{std::string(text.substr(0, has_port ? colon : text.size())), "14158"};
  if (has_port) {
    address.port = text.substr(colon + 1);
    std::uint16_t port = 0;
    const char* end = address.port.data() + address.port.size();
    const auto [rest, error] = std::from_chars(address.port.data(), end, port);
    if (error != std::errc{} || rest != end || port == 0) return {};
  }
  if (address.host.starts_with('[') && address.host.ends_with(']'))
    address.host = address.host.substr(1, address.host.size() - 2);
  else if (address.host.find_first_of(":[]") != std::string::npos)
    return {};
  if (address.host.empty() || address.host.find_first_of(" /") != std::string::npos) return {};
  return address;
}

DisplayServer::DisplayServer(const ServerAddress& address, const Log& log)
    : address_(address.host + ':' + address.port), log_(log) {
  connect(address);
}

DisplayServer::~DisplayServer() {
  if (socket_ >= 0) ::close(socket_);
}

void DisplayServer::connect(const ServerAddress& address) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  const int unknown = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (unknown != 0) return give_up(::gai_strerror(unknown));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list(found, ::freeaddrinfo);
  int failure = 0;
  for (const addrinfo* a = found; a != nullptr && socket_ < 0; a = a->ai_next) {
    const int socket = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    failure = socket < 0 ? errno : connect_within(socket, *a, kPatience);
    if (failure == 0)
      socket_ = socket;
    else if (socket >= 0)
      ::close(socket);
  }
  if (socket_ < 0) give_up(std::strerror(failure));
  connected_ = Clock::now();
}

void DisplayServer::create(const std::string& name, const Image& image) {
  std::string packet = begin_packet(PacketType::create_image, true, name);
  put(packet, std::int32_t(image.width));
  put(packet, std::int32_t(image.height));
  put_channel_names(packet);
  send(std::move(packet));
}

void DisplayServer::update(const std::string& name, const Image& image, const Rectangle& part) {
  std::string packet = begin_packet(PacketType::update_image, false, name);
  put_channel_names(packet);
  const int x = part.x0 - image.crop_x, y = part.y0 - image.crop_y;
  const std::size_t width = std::size_t(part.x1 - part.x0), height = std::size_t(part.y1 - part.y0);
  for (const int value : {x, y, int(width), int(height)}) put(packet, std::int32_t(value));
  for (std::size_t c = 0; c < kChannels.size(); ++c) put(packet, std::int64_t(c));  // the first value's place
  for (std::size_t c = 0; c < kChannels.size(); ++c) put(packet, std::int64_t(kChannels.size()));  // the step
  const std::size_t channels = image.channels.size();
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t pixel = (std::size_t(y) + row) * std::size_t(image.width) + std::size_t(x) + column;
      packet.append(reinterpret_cast<const char*>(image.pixels.data() + pixel * channels),
                    kChannels.size() * sizeof(float));
    }
  send(std::move(packet));
}

void DisplayServer::send(std::string packet) {
  if (!is_connected()) return;
  const auto length = std::uint32_t(packet.size());
  std::memcpy(packet.data(), &length, sizeof length);
  for (std::size_t sent = 0; sent < packet.size();) {
    const Clock::time_point before = Clock::now();
    const ssize_t n = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    const int failure = errno;
    waited_ += Clock::now() - before;
    if (n < 0 && failure == EINTR) continue;
    if (n <= 0) return give_up(failure == EAGAIN ? "it does not answer" : std::strerror(failure));
    sent += std::size_t(n);
    if (sent < packet.size() && is_too_slow()) return give_up("it is too slow");
  }
}

bool DisplayServer::is_too_slow() const {
  const std::chrono::duration<double> since = Clock::now() - connected_;
  return waited_.count() > kTotalPatience + kShareOfTime * since.count();
}

void DisplayServer::give_up(const std::string& why) {
  print_warning(log_, "no pictures are shown by the viewer at " + address_ + ": " + why);
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

}  // namespace opaline
