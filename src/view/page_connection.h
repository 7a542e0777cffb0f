// SPDX-License-Identifier: GPL-3.0-or-later
// One page's WebSocket: what it asks, and the newest of everything it is to know.
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "view/view_renderer.h"

namespace opaline {

using SharedText = std::shared_ptr<const std::string>;
using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Messages for a page, in the order of sending. A newer text of a kind replaces a waiting one, so
/// kind, so no page makes the server store more than one of each.
enum class PageText : std::size_t {
  schema,
  scene,
  failed,
  plan,
  report,
  work,
  behind,
  trade,
  reference,
  kCount
};

/// A picture as bytes, and the number in them.
struct PackedFrame {
  std::uint32_t number = 0;
  SharedText bytes;
};

/// Pictures are sent whole. Behind a slow connection the newest one waits, in place of older ones, which are never sent.
class PageConnection : public std::enable_shared_from_this<PageConnection> {
 public:
  /// All on the thread of the connection.
  struct Events {
    std::function<void(PageConnection& page)> opened;
    std::function<void(PageConnection& page, std::string_view text)> message;
    std::function<PackedFrame(const std::shared_ptr<const ViewPicture>& picture, const std::string& layer)>
        pack;
    std::function<void(PageConnection& page, const std::string& why)> closed;  ///< why: empty if it just left
  };

  /// slot: released when the connection ends
  PageConnection(boost::beast::tcp_stream&& stream, Events events, std::shared_ptr<void> slot);

  /// Answers the request for a WebSocket, and goes on until the page leaves.
  void start(const HttpRequest& request);

  void send(PageText kind, SharedText text);
  /// An answer; while kMostAnswers wait, nothing more is read.
  void answer(std::string text);
  /// In place of a picture that waits, or of a reference that waits. A page has at most kMostFrames that it has not yet
  /// shown.
  void send(std::shared_ptr<const ViewPicture> picture);
  void shown(std::uint32_t frame);
  void choose_layer(std::string layer) { layer_ = std::move(layer); }

 private:
  void read();
  void write();
  bool take_frame();
  void written(boost::beast::error_code error);
  void end(boost::beast::error_code error);

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  Events events_;
  std::shared_ptr<void> slot_;
  boost::beast::flat_buffer in_;
  std::array<SharedText, std::size_t(PageText::kCount)> texts_;
  std::deque<SharedText> answers_;
  std::shared_ptr<const ViewPicture> picture_, reference_;
  std::deque<std::uint32_t> unshown_;
  std::string layer_;
  SharedText out_;  ///< being written
  bool is_open_ = false, is_reading_ = false, has_ended_ = false;
};

}  // namespace opaline
