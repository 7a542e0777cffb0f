// SPDX-License-Identifier: GPL-3.0-or-later
// Scene on a web page: one network thread owning the edits, one renderer, any number of pages with the same
// view.
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
  std::uint16_t port = 0;             ///< 0: any free port
  std::string token;                  ///< empty: a random one
  std::string folder;                 ///< for files dropped onto the page
};

/// Callbacks of the server.
struct ViewHooks {
  /// Reports a refused request or page with the reason, one line. On the thread of `run`.
  std::function<void(const std::string& text)> refused;
  /// Command rendering a scene file or asset with these overrides.
  std::function<std::string(const std::string& scene, const std::vector<std::string>& overrides,
                            std::optional<int> frame)>
      command;
  /// Renders a scene to an image; on a separate thread. frame: the path then contains ## for its number
  /// error Error, with its text shown on the pages
  std::function<void(const std::string& scene, const std::vector<std::string>& overrides,
                     std::optional<int> frame, const std::string& path, Monitor& monitor)>
      render_file;
};

/// Maximum pages, and connections of any kind. More are closed.
inline constexpr std::size_t kMostPages = 16, kMostConnections = 64;

class ViewServer {
 public:
  /// Starts listening.
  /// error Error{bad_input}: not an IP address, or an invalid token; Error{run_failed}: the port is
  ///       unavailable
  ViewServer(SceneEdits edits, ViewOptions options, ViewHooks hooks);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// URL of the page.
  std::string url() const;

  /// Serves until `stop`.
  void run();
  /// Callable on any thread.
  void stop();
  /// Stops on SIGINT or SIGTERM; a second signal of the same kind kills.
  void stop_at_signals();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace opaline
