// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_server.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <boost/asio/ip/host_name.hpp>
#include <csignal>
#include <utility>

#include "opaline/error.h"
#include "view/view_address.h"
#include "view/view_frame.h"
#include "view/view_json.h"
#include "view/view_server_state.h"

namespace opaline {
namespace {

namespace asio = boost::asio;
using boost::beast::error_code;

/// Closes the server's sockets in child processes rendering a file.
void close_in_children(int socket) {
  ::fcntl(socket, F_SETFD, FD_CLOEXEC);
}

}  // namespace

ViewServer::State::State(SceneEdits scene_edits, const ViewOptions& options, ViewHooks view_hooks)
    : edits(std::move(scene_edits)),
      dropped(options.folder),
      hooks(std::move(view_hooks)),
      acceptor(io),
      timer(io),
      signals(io) {
  rules.token = options.token.empty() ? random_token() : options.token;
  check_token(rules.token);
  const Address wanted = address_of(options);
  try {
    acceptor.open(wanted.protocol());
    close_in_children(acceptor.native_handle());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(wanted);
    acceptor.listen();
  } catch (const boost::system::system_error& failure) {
    throw run_failed(host_text(options.address, options.port), "cannot listen: " + failure.code().message());
  }
  const std::uint16_t port = acceptor.local_endpoint().port();
  const bool is_everywhere = wanted.address().is_unspecified();
  const std::string host = is_everywhere ? asio::ip::host_name() : wanted.address().to_string();
  if (!is_everywhere) rules.hosts = {host_text(host, port), host_text("localhost", port)};
  url = fmt::format("http://{}/{}/", host_text(host, port), rules.token);
  schema = std::make_shared<const std::string>(schema_text());
}

ViewServer::State::~State() {
  file_monitor.cancelled = true;
  background.reset();
  renderer.reset();
}

void ViewServer::State::accept() {
  acceptor.async_accept([this](error_code error, asio::ip::tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    accept();
    if (error) return hooks.refused("a connection: " + error.message());
    close_in_children(socket.native_handle());
    error_code no_peer;
    const Address peer = socket.remote_endpoint(no_peer);
    const std::string from = host_text(peer.address().to_string(), peer.port());
    if (*connections >= kMostConnections)
      return hooks.refused(fmt::format("{}: more than {} connections", from, kMostConnections));
    ++*connections;
    const std::shared_ptr<void> slot(nullptr, [count = connections](void*) { --*count; });
    const HttpConnection::Events events{
        [this](boost::beast::tcp_stream&& stream, const HttpRequest& request, std::shared_ptr<void> taken) {
          open_page(std::move(stream), request, std::move(taken));
        },
        [this](std::string_view address, std::uint64_t bytes) { return dropped.begin(address, bytes); },
        [this](std::string_view address) { dropped.end(address); },
        [this, from](const std::string& why) { hooks.refused(from + ": " + why); }};
    std::make_shared<HttpConnection>(std::move(socket), rules, events, slot)->start();
  });
}

void ViewServer::State::open_page(boost::beast::tcp_stream&& stream, const HttpRequest& request,
                                  std::shared_ptr<void> slot) {
  if (pages.size() >= kMostPages) return hooks.refused(fmt::format("more than {} pages", kMostPages));
  const auto page = std::make_shared<PageConnection>(std::move(stream), page_events(), std::move(slot));
  pages.insert(page.get());
  page->start(request);
}

PageConnection::Events ViewServer::State::page_events() {
  return {[this](PageConnection& page) { greet(page); },
          [this](PageConnection& page, std::string_view text) { receive(page, text); },
          [this](const std::shared_ptr<const ViewPicture>& shown, const std::string& layer) {
            return pack(shown, layer);
          },
          [this](PageConnection& page, const std::string& why) {
            pages.erase(&page);
            if (picking == &page) picking = nullptr;
            if (pages.empty()) work_behind({});  // no page needs it
            if (!why.empty()) hooks.refused("a page: " + why);
          }};
}

void ViewServer::State::greet(PageConnection& page) {
  page.send(PageText::schema, schema);
  for (const auto& [kind, text] : texts) page.send(kind, text);
  if (picture != nullptr) page.send(picture);
  if (reference != nullptr) page.send(reference);
}

PackedFrame ViewServer::State::pack(const std::shared_ptr<const ViewPicture>& shown,
                                    const std::string& layer) {
  if (shown != picture)
    return {++frames, std::make_shared<const std::string>(pack_frame(*shown, frames, layer))};
  PackedFrame& frame = packed[layer];
  if (frame.bytes == nullptr) {
    frame.number = ++frames;
    frame.bytes = std::make_shared<const std::string>(pack_frame(*shown, frame.number, layer));
  }
  return frame;
}

void ViewServer::State::tell(PageText kind, std::string text) {
  const SharedText shared = texts[kind] = std::make_shared<const std::string>(std::move(text));
  for (PageConnection* page : pages) page->send(kind, shared);
}

ViewServer::ViewServer(SceneEdits edits, ViewOptions options, ViewHooks hooks)
    : state_(std::make_unique<State>(std::move(edits), options, std::move(hooks))) {}
ViewServer::~ViewServer() = default;

std::string ViewServer::url() const {
  return state_->url;
}

void ViewServer::stop() {
  state_->io.stop();
}

void ViewServer::stop_at_signals() {
  for (const int signal : {SIGINT, SIGTERM}) state_->signals.add(signal);
  state_->signals.async_wait([state = state_.get()](error_code error, int) {
    if (error) return;
    state->signals.clear();
    state->io.stop();
  });
}

void ViewServer::run() {
  State& state = *state_;
  state.renderer = std::make_unique<ViewRenderer>(state.renderer_events());
  state.background = std::make_unique<ViewBackground>(state.background_events());
  state.after_edit();
  state.accept();
  // Running out of memory while serving one page does not end the others.
  while (!state.io.stopped()) try {
      state.io.run();
    } catch (const std::exception& failure) {
      state.hooks.refused(std::string("a page: ") + failure.what());
    }
}

}  // namespace opaline
