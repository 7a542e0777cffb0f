// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_address.h"

#include <fmt/format.h>

#include <random>

#include "opaline/error.h"
#include "values/json_tree.h"

namespace opaline {
namespace {

constexpr std::size_t kShortestToken = 16, kLongestToken = 64;

}  // namespace

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

void check_token(const std::string& token) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (token.size() < kShortestToken || token.size() > kLongestToken ||
      token.find_first_not_of(kAllowed) != std::string::npos)
    throw Error(ErrorKind::bad_input, {}, 0, 0, "--token",
                fmt::format("{} to {} of the characters a-z A-Z 0-9 _ -", kShortestToken, kLongestToken),
                "'" + printable(token) + "'");
}

Address address_of(const ViewOptions& options) {
  boost::system::error_code error;
  const boost::asio::ip::address address = boost::asio::ip::make_address(options.address, error);
  if (error)
    throw Error(ErrorKind::bad_input, {}, 0, 0, "--listen", "an IP address such as 127.0.0.1",
                "'" + printable(options.address) + "'");
  return {address, options.port};
}

std::string host_text(const std::string& host, std::uint16_t port) {
  const bool is_v6 = host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", is_v6 ? "[" : "", host, is_v6 ? "]" : "", port);
}

}  // namespace opaline
