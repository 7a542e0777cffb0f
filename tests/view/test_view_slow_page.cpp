// SPDX-License-Identifier: GPL-3.0-or-later
// The page behind a slow line, in the browser.
#include <algorithm>
#include <atomic>

#include "view_page.h"

namespace opaline {
namespace {

using namespace test;

/// A line to a server: what comes from there comes at 2 MB/s, and little of it is on the way.
class SlowProxy {
 public:
  explicit SlowProxy(Tcp::endpoint server) : server_(std::move(server)) {
    acceptor_.non_blocking(true);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        beast::error_code none_yet;
        Tcp::socket page = acceptor_.accept(none_yet);
        if (none_yet)
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        else
          lines_.emplace_back(&SlowProxy::carry, this, std::move(page));
      }
    });
  }
  std::string url() const {
    return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/" + kToken + "/";
  }
  std::atomic<std::size_t> bytes = 0;  ///< that came from the server

 private:
  void carry(Tcp::socket page) {
    asio::io_context io;
    Tcp::socket server(io);
    server.open(server_.protocol());
    server.set_option(asio::socket_base::receive_buffer_size(1 << 14));
    page.non_blocking(false);
    server.connect(server_);
    std::jthread asks([&] { forward(page, server, 1 << 16, {}); });
    forward(server, page, 1 << 14, std::chrono::milliseconds(8));
  }
  void forward(Tcp::socket& from, Tcp::socket& to, std::size_t most, std::chrono::milliseconds pause) {
    std::string part(most, '\0');
    beast::error_code end;
    while (!end) {
      const std::size_t count = from.read_some(asio::buffer(part), end);
      if (pause.count() > 0) bytes += count;
      if (!end) asio::write(to, asio::buffer(part.data(), count), end);
      std::this_thread::sleep_for(pause);
    }
    from.shutdown(Tcp::socket::shutdown_both, end);
    to.shutdown(Tcp::socket::shutdown_both, end);
  }

  Tcp::endpoint server_;
  asio::io_context io_;
  Tcp::acceptor acceptor_{io_, Tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0)};
  std::vector<std::jthread> lines_;
  std::jthread thread_;
};

struct LongViewSlowPage : LongViewPage {
  LongViewSlowPage() {
    browser.call(tab, "Page.navigate", {{"url", "about:blank"}});
    view.emplace(folder.scene, std::uint16_t(0), std::vector<int>{}, "0.0.0.0");
    proxy.emplace(view->endpoint());
    browser.call(tab, "Page.navigate", {{"url", proxy->url()}});
  }
  void TearDown() override {
    browser.call(tab, "Page.navigate", {{"url", "about:blank"}});
    view.reset();
    LongViewPage::TearDown();
  }
  std::optional<SlowProxy> proxy;
};

// Claim: behind a slow line the final picture is exactly that of `opaline render`, after less than half of its bytes; so
// are a layer's values and the colours after it. Source: the help of view, view_frame.h. Fails if: planes or bands land at
// another place, or a JPEG passes for the final picture.
TEST_F(LongViewSlowPage, ShowsTheExactPicture) {
  final_edits();
  type("film.resolution", "resolution width", "512");
  type("film.resolution", "resolution height", "512");
  std::vector<std::string> edits = final_edits(3);
  expect_shown(rendered(folder.scene, edits));
  const std::size_t before = proxy->bytes;
  type("media.stone.specular_ior", "specular_ior", "1.3");
  edits = final_edits(4);
  expect_shown(rendered(folder.scene, edits));
  EXPECT_LT(proxy->bytes - before, std::size_t(512 * 512 * 8 / 2));
}

}  // namespace
}  // namespace opaline
