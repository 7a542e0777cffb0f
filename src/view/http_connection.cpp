// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/http_connection.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "opaline/error.h"
#include "view/dropped_files.h"
#include "view/page_files.h"

namespace opaline {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr std::size_t kLongestHeader = 8192, kBuffer = 1 << 18;  // bytes
constexpr std::chrono::seconds kPatience{10};                    // without any progress
constexpr unsigned kVersion = 11;                                // HTTP/1.1

/// Constant-time comparison: its duration does not depend on the matching prefix.
bool same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) difference |= unsigned(a[i] ^ b[i]);
  return difference == 0;
}

std::string text_of(beast::string_view view) {
  return {view.data(), view.size()};
}

}  // namespace

std::string allowed_path(const HttpRequest& request, const AccessRules& rules,
                         std::optional<Refusal>& refusal) {
  const std::string target = text_of(request.target()), host = text_of(request[http::field::host]);
  const std::size_t slash = std::min(target.find('/', 1), target.size());
  const auto refuse = [&](http::status status, const std::string& why) {
    refusal = Refusal{status, why};
    return std::string();
  };
  if (!rules.hosts.empty() && std::ranges::find(rules.hosts, host) == rules.hosts.end())
    return refuse(http::status::forbidden, "another host's name");
  if (!target.starts_with('/') || !same_secret(target.substr(1, slash - 1), rules.token))
    return refuse(http::status::forbidden, "wrong token");
  const bool is_upload = request.method() == http::verb::put;
  if (request.method() != http::verb::get && !is_upload)
    return refuse(http::status::method_not_allowed, "not a GET or PUT request");
  const std::string path = target.substr(slash);
  const bool is_socket = beast::websocket::is_upgrade(request);
  if ((is_socket || is_upload) && text_of(request[http::field::origin]) != "http://" + host)
    return refuse(http::status::forbidden, "foreign Origin");
  if (is_socket != (path == "/socket") || is_upload != path.starts_with(DroppedFiles::kAddress))
    return refuse(http::status::not_found, "unknown path");
  return path;
}

HttpConnection::HttpConnection(boost::asio::ip::tcp::socket&& socket, const AccessRules& rules, Events events,
                               std::shared_ptr<void> slot)
    : stream_(std::move(socket)),
      rules_(rules),
      events_(std::move(events)),
      slot_(std::move(slot)),
      in_(kBuffer) {
  parser_.header_limit(kLongestHeader);
  parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // checked by DroppedFiles::begin
}

void HttpConnection::start() {
  stream_.expires_after(kPatience);
  http::async_read_header(stream_, in_, parser_,
                          [self = shared_from_this()](beast::error_code error, std::size_t) {
                            if (!error) return self->answer();
                            if (error != http::error::end_of_stream && error != beast::error::timeout)
                              self->events_.refused("not an HTTP request: " + error.message());
                          });
}

void HttpConnection::answer() {
  std::optional<Refusal> refusal;
  const std::string path = allowed_path(parser_.get(), rules_, refusal);
  if (refusal) return refuse(*refusal);
  if (path.starts_with(DroppedFiles::kAddress)) return begin_upload(path);
  if (!parser_.is_done()) return refuse({http::status::bad_request, "a GET request with a body"});
  if (path == "/socket") return events_.web_socket(std::move(stream_), parser_.get(), std::move(slot_));
  for (const PageFile& file : page_files())
    if (path == file.path) return respond(http::status::ok, file.type, std::string(file.bytes));
  respond(http::status::not_found, "text/plain", "there is no such file\n");
}

void HttpConnection::begin_upload(const std::string& address) {
  if (!parser_.content_length())
    return refuse({http::status::length_required, "an upload without its length"});
  beast::error_code error;
  try {
    const std::string path = events_.upload(address, *parser_.content_length());
    upload_address_ = address;
    upload_.emplace(std::move(parser_));
    upload_->get().body().open(path.c_str(), beast::file_mode::write, error);
  } catch (const Error& failure) {
    return refuse({http::status::bad_request, failure.what()});
  }
  if (error)
    return refuse({http::status::insufficient_storage, "cannot store an upload: " + error.message()});
  receive_upload();
}

void HttpConnection::receive_upload() {
  if (upload_->is_done()) {
    upload_->get().body().close();
    events_.uploaded(upload_address_);
    return respond(http::status::ok, "text/plain", "");
  }
  stream_.expires_after(kPatience);
  http::async_read_some(
      stream_, in_, *upload_, [self = shared_from_this()](beast::error_code error, std::size_t) {
        if (!error) return self->receive_upload();
        if (error == beast::errc::no_space_on_device || error == beast::errc::file_too_large ||
            error == beast::errc::io_error)
          return self->refuse(
              {http::status::insufficient_storage, "cannot store an upload: " + error.message()});
        self->events_.refused("an upload ended early: " + error.message());
      });
}

void HttpConnection::refuse(const Refusal& refusal) {
  events_.refused(refusal.why);
  respond(refusal.status, "text/plain", refusal.why + "\n");
}

void HttpConnection::respond(http::status status, const std::string& type, std::string body) {
  response_ = {status, kVersion};
  response_.set(http::field::content_type, type.starts_with("text/") ? type + "; charset=utf-8" : type);
  response_.set(http::field::cache_control, "no-store");
  response_.set("Referrer-Policy", "no-referrer");
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set(
      "Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  response_.keep_alive(false);
  response_.body() = std::move(body);
  response_.prepare_payload();
  http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
  });
}

}  // namespace opaline
