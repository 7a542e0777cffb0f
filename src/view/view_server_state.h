// SPDX-License-Identifier: GPL-3.0-or-later
// State of the server on its network thread. Its functions are in view_server.cpp (connections), page_requests.cpp
// (messages of pages) and renderer_events.cpp (news of the renderers).
#pragma once

#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "view/dropped_files.h"
#include "view/file_watch.h"
#include "view/http_connection.h"
#include "view/view_background.h"
#include "view/view_server.h"

namespace opaline {

struct ViewServer::State {
  State(SceneEdits scene_edits, const ViewOptions& options, ViewHooks view_hooks);
  ~State();

  void accept();
  void open_page(boost::beast::tcp_stream&& stream, const HttpRequest& request, std::shared_ptr<void> slot);
  PageConnection::Events page_events();
  void greet(PageConnection& page);
  void receive(PageConnection& page, std::string_view text);
  void change_scene(const PageMessage& message);
  void act(PageConnection& page, const PageMessage& message);
  void after_edit(bool has_new_files = false);
  std::string by_scene_camera() const;
  void open(PageConnection& page, const OpenFiles& dropped);
  void light_by(const std::string& name);
  void find_environments();
  void reload(const std::set<std::string>& files);
  void pick(PageConnection& page, const Pick& place);
  void set_floor(bool is_on);
  void save(PageConnection& page, const std::string& name);
  void render_file(PageConnection& page, const std::string& name);
  PackedFrame pack(const std::shared_ptr<const ViewPicture>& picture, const std::string& layer);
  ViewEvents renderer_events();
  BackgroundEvents background_events();
  void work_behind(const WorkBehind& wanted);
  void take(const ChosenSettings& chosen);
  void tell(PageText kind, std::string text);
  void show_progress();

  boost::asio::io_context io;
  SceneEdits edits;
  DroppedFiles dropped;
  ViewHooks hooks;
  AccessRules rules;
  boost::asio::ip::tcp::acceptor acceptor;
  boost::asio::steady_timer timer;
  boost::asio::signal_set signals;
  bool shows_progress = false;
  std::string url;
  SharedText schema;
  std::map<PageText, SharedText> texts;  ///< the newest of each kind
  std::shared_ptr<const ViewPicture> picture, reference;
  std::map<std::string, PackedFrame> packed;  ///< packed frames of `picture`, by layer
  std::uint32_t frames = 0;
  std::set<PageConnection*> pages;
  std::shared_ptr<std::size_t> connections = std::make_shared<std::size_t>(0);
  std::set<std::string> written;
  Monitor file_monitor;
  bool renders_file = false;
  std::jthread file_thread;
  std::unique_ptr<ViewRenderer> renderer;
  std::unique_ptr<ViewBackground> background;
  BackgroundWork asked;  ///< requested background work
  PageConnection* picking = nullptr;
  std::vector<Bounds> boxes;         ///< bounds of the shapes, as last loaded, mm
  std::uint32_t first_revision = 0;  ///< first one of the opened scene; boxes of earlier ones are stale
  std::map<std::string, std::string> environments;  ///< offered ones, by name
  std::string offered_for, first_folder;            ///< scene file of `environments`; folder of the first one
  std::set<std::string> changed_files;              ///< since the scene was read
  FileWatch watch{io, [this](const std::set<std::string>& files) { reload(files); }};
};

}  // namespace opaline
