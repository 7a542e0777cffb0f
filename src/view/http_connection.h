// SPDX-License-Identifier: GPL-3.0-or-later
// One request: a file of the page, the start of its WebSocket, or a file uploaded by it.
#pragma once

#include <boost/beast/http/file_body.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "view/page_connection.h"

namespace opaline {

/// Access control.
struct AccessRules {
  std::string token;               ///< first part of every path
  std::vector<std::string> hosts;  ///< allowed values of the header Host; empty: any
};

/// Reason of a refusal: the status and a text.
struct Refusal {
  boost::beast::http::status status = boost::beast::http::status::ok;
  std::string why;
};

/// Path of the request after the token.
/// refusal: its reason; a WebSocket and an upload need the page's own Origin
std::string allowed_path(const HttpRequest& request, const AccessRules& rules,
                         std::optional<Refusal>& refusal);

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  struct Events {
    std::function<void(boost::beast::tcp_stream&& stream, const HttpRequest& request,
                       std::shared_ptr<void> slot)>
        web_socket;
    /// Returns the file to write an upload to.
    /// error Error
    std::function<std::string(std::string_view address, std::uint64_t bytes)> upload;
    std::function<void(std::string_view address)> uploaded;
    std::function<void(const std::string& why)> refused;
  };

  HttpConnection(boost::asio::ip::tcp::socket&& socket, const AccessRules& rules, Events events,
                 std::shared_ptr<void> slot);

  void start();

 private:
  void answer();
  void begin_upload(const std::string& address);
  void receive_upload();
  void refuse(const Refusal& refusal);
  void respond(boost::beast::http::status status, const std::string& type, std::string body);

  boost::beast::tcp_stream stream_;
  const AccessRules& rules_;
  Events events_;
  std::shared_ptr<void> slot_;
  boost::beast::flat_buffer in_;
  boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::file_body>> upload_;
  std::string upload_address_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
};

}  // namespace opaline
