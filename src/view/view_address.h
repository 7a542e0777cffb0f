// SPDX-License-Identifier: GPL-3.0-or-later
// Address and access token of the view.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <string>

#include "view/view_server.h"

namespace opaline {

using Address = boost::asio::ip::tcp::endpoint;

/// 128 random bits, hexadecimal.
std::string random_token();

/// error Error{bad_input}: too short, too long, or with characters escaped in a URL
void check_token(const std::string& token);

/// error Error{bad_input}: no IP address
Address address_of(const ViewOptions& options);

/// "127.0.0.1:8080" or "[::1]:8080".
std::string host_text(const std::string& host, std::uint16_t port);

}  // namespace opaline
