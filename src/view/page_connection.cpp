// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/page_connection.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace opaline {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr std::size_t kLongestMessage = 1 << 16;  // bytes
constexpr std::size_t kMostAnswers = 16, kMostFrames = 2;
constexpr std::chrono::seconds kSilence{60};  // then the page is gone; half of it without a word is a ping
// Send buffer of the system, doubled by Linux. Small, because a frame in it cannot be replaced by a newer
// one.
constexpr int kSendBuffer = 1 << 17;

}  // namespace

PageConnection::PageConnection(beast::tcp_stream&& stream, Events events, std::shared_ptr<void> slot)
    : socket_(std::move(stream)), events_(std::move(events)), slot_(std::move(slot)), in_(kLongestMessage) {}

void PageConnection::start(const HttpRequest& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has times of its own
  beast::error_code not_vital;
  beast::get_lowest_layer(socket_).socket().set_option(
      boost::asio::socket_base::send_buffer_size(kSendBuffer), not_vital);
  socket_.set_option(websocket::stream_base::timeout{kSilence, kSilence, true});
  socket_.read_message_max(kLongestMessage);
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return self->end(error);
    self->is_open_ = true;
    self->events_.opened(*self);
    self->read();
    self->write();
  });
}

void PageConnection::read() {
  if (is_reading_ || has_ended_ || answers_.size() >= kMostAnswers) return;
  is_reading_ = true;
  socket_.async_read(in_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->is_reading_ = false;
    if (error) return self->end(error);
    const auto bytes = self->in_.cdata();
    self->events_.message(*self, {static_cast<const char*>(bytes.data()), bytes.size()});
    self->in_.consume(self->in_.size());
    self->read();
  });
}

void PageConnection::send(PageText kind, SharedText text) {
  texts_[std::size_t(kind)] = std::move(text);
  write();
}

void PageConnection::answer(std::string text) {
  answers_.push_back(std::make_shared<const std::string>(std::move(text)));
  write();
}

void PageConnection::send(std::shared_ptr<const ViewPicture> picture) {
  (picture->step == PictureStep::reference ? reference_ : picture_) = std::move(picture);
  write();
}

void PageConnection::shown(std::uint32_t frame) {
  // Numbers may decrease: a layer packed earlier keeps its number.
  const auto last = std::find(unshown_.rbegin(), unshown_.rend(), frame);
  unshown_.erase(unshown_.begin(), last.base());
  write();
}

void PageConnection::write() {
  if (!is_open_ || has_ended_ || out_ != nullptr) return;
  const auto text = std::ranges::find_if(texts_, [](const SharedText& t) { return t != nullptr; });
  bool is_binary = false;
  if (!answers_.empty()) {
    out_ = std::move(answers_.front());
    answers_.pop_front();
  } else if (text != texts_.end()) {
    out_ = std::exchange(*text, nullptr);
  } else if (unshown_.size() < kMostFrames && take_frame()) {
    is_binary = true;
  } else {
    return;
  }
  socket_.binary(is_binary);
  socket_.async_write(
      boost::asio::buffer(*out_),
      [self = shared_from_this()](beast::error_code error, std::size_t) { self->written(error); });
}

bool PageConnection::take_frame() {
  auto& next = picture_ != nullptr ? picture_ : reference_;
  if (next == nullptr) return false;
  const PackedFrame frame = events_.pack(std::exchange(next, nullptr), layer_);
  unshown_.push_back(frame.number);
  out_ = frame.bytes;
  return true;
}

void PageConnection::written(beast::error_code error) {
  out_ = nullptr;
  if (error) return end(error);
  read();
  write();
}

void PageConnection::end(beast::error_code error) {
  if (std::exchange(has_ended_, true)) return;
  const bool just_left = error == websocket::error::closed || error == boost::asio::error::eof ||
                         error == boost::asio::error::connection_reset ||
                         error == boost::asio::error::broken_pipe ||
                         error == boost::asio::error::not_connected ||
                         error == boost::asio::error::operation_aborted || error == beast::error::timeout;
  events_.closed(*this, just_left ? "" : error.message());
}

}  // namespace opaline
