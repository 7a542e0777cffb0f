// SPDX-License-Identifier: GPL-3.0-or-later
// WebSocket of one page: its requests, and the newest message of each kind.
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

/// Messages for a page, in the order of sending. A newer text of a kind replaces a waiting one, so a page
/// stores at most one of each.
enum class PageText : std::size_t {
  schema,
  scene,
  failed,
  plan,
  report,
  work,
  file,
  behind,
  trade,
  reference,
  kCount
};

/// An image as bytes, and the number in them.
struct PackedFrame {
  std::uint32_t number = 0;
  SharedText bytes;
};

/// Sends images as a whole. Behind a slow connection, the newest waiting image replaces older ones.
class PageConnection : public std::enable_shared_from_this<PageConnection> {
 public:
  /// All calls on the connection's thread.
  struct Events {
    std::function<void(PageConnection& page)> opened;
    std::function<void(PageConnection& page, std::string_view text)> message;
    std::function<PackedFrame(const std::shared_ptr<const ViewPicture>& picture, const std::string& layer)>
        pack;
    std::function<void(PageConnection& page, const std::string& why)> closed;  ///< why: empty: normal end
  };

  /// slot: released when the connection ends
  PageConnection(boost::beast::tcp_stream&& stream, Events events, std::shared_ptr<void> slot);

  /// Accepts the WebSocket, and continues until the page leaves.
  void start(const HttpRequest& request);

  void send(PageText kind, SharedText text);
  /// Queues an answer. With kMostAnswers waiting, reading stops.
  void answer(std::string text);
  /// Queues an image, replacing a waiting one; references likewise. A page has at most kMostFrames
  /// unconfirmed images.
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
