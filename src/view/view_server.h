// SPDX-License-Identifier: GPL-3.0-or-later
// A scene on a page: one network thread that keeps the edits, one renderer, any number of pages that see the same.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "opaline/monitor.h"
#include "view/scene_edits.h"

namespace opaline {

struct ViewOptions {
  std::string address = "127.0.0.1";  ///< IP; an unspecified one listens on all
  std::uint16_t port = 0;             ///< 0: any that is free
  std::string token;                  ///< empty: a random one
};

/// Tasks that the server leaves to its caller.
struct ViewHooks {
  /// A request or page that is refused, and why; one line. On the thread of `run`.
  std::function<void(const std::string& text)> refused;
  /// The command that renders the scene with these overrides.
  std::function<std::string(const std::vector<std::string>& overrides, std::optional<int> frame)> command;
  /// Renders it to a file; on a thread of its own. frame: then the path has ## for its number
  /// error Error, whose text the pages are told
  std::function<void(const std::vector<std::string>& overrides, std::optional<int> frame,
                     const std::string& path, Monitor& monitor)>
      render_file;
};

/// Pages at once, and connections of any kind. More are closed.
inline constexpr std::size_t kMostPages = 16, kMostConnections = 64;

class ViewServer {
 public:
  /// Listens from now on.
  /// error Error{bad_input}: no IP address, a token that is none; Error{run_failed}: the port cannot be had
  ViewServer(SceneEdits edits, ViewOptions options, ViewHooks hooks);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// Where the page is.
  std::string url() const;

  /// Serves until `stop`.
  void run();
  /// On any thread.
  void stop();
  /// SIGINT or SIGTERM is to stop it; a second one of its kind kills.
  void stop_at_signals();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace opaline
