// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "asset_files/asset_file.h"
#include "core/atomic_file.h"
#include "input/load_scene.h"
#include "opaline/error.h"
#include "render/render.h"
#include "scene/names.h"
#include "values/frame_name.h"
#include "values/json_tree.h"
#include "view/dropped_files.h"
#include "view/file_watch.h"
#include "view/http_connection.h"
#include "view/view_address.h"
#include "view/view_background.h"
#include "view/view_frame.h"
#include "view/view_json.h"

namespace opaline {
namespace {

namespace asio = boost::asio;
using boost::beast::error_code;

constexpr std::chrono::milliseconds kTick{100};

/// Closes the server's sockets in child processes rendering a file.
void close_in_children(int socket) {
  ::fcntl(socket, F_SETFD, FD_CLOEXEC);
}

/// Path of a file beside the scene. Replaces only files written by this server.
std::string path_beside(const std::string& scene, const std::string& name,
                        const std::vector<std::string>& extensions, const std::set<std::string>& written) {
  const std::filesystem::path file(name);
  if (!is_plain_name(name) || std::ranges::find(extensions, file.extension().string()) == extensions.end())
    throw bad_file("", "invalid file name",
                   fmt::format("a name without a folder that ends in {}", fmt::join(extensions, " or ")),
                   "'" + printable(name) + "'");
  const std::string path = (std::filesystem::path(scene).parent_path() / file).string();
  if (std::filesystem::exists(std::filesystem::symlink_status(path)) && !written.contains(path))
    throw bad_file(path, "exists, and was not written by this view", "another name");
  return path;
}

}  // namespace

struct ViewServer::State {
  State(SceneEdits scene_edits, const ViewOptions& options, ViewHooks view_hooks);
  ~State();

  void accept();
  void open_page(boost::beast::tcp_stream&& stream, const HttpRequest& request, std::shared_ptr<void> slot);
  PageConnection::Events page_events();
  void greet(PageConnection& page);
  void receive(PageConnection& page, std::string_view text);
  void act(PageConnection& page, const PageMessage& message);
  void after_edit(bool has_new_files = false);
  std::string by_scene_camera() const;
  void open(PageConnection& page, const OpenFiles& dropped);
  void reload(const std::set<std::string>& files);
  void pick(PageConnection& page, const Pick& place);
  void save(PageConnection& page, const std::string& name);
  void render_file(PageConnection& page, const std::string& name);
  PackedFrame pack(const std::shared_ptr<const ViewPicture>& picture, const std::string& layer);
  ViewEvents renderer_events();
  BackgroundEvents background_events();
  void work_behind(const WorkBehind& wanted);
  void take(const ChosenSettings& chosen);
  void tell(PageText kind, std::string text);
  void show_progress();

  asio::io_context io;
  SceneEdits edits;
  DroppedFiles dropped;
  ViewHooks hooks;
  AccessRules rules;
  asio::ip::tcp::acceptor acceptor;
  asio::steady_timer timer;
  asio::signal_set signals;
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
  std::set<std::string> changed_files;  ///< since the scene was read
  FileWatch watch{io, [this](const std::set<std::string>& files) { reload(files); }};
};

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

// ---- connections ----------------------------------------------------------------------------------------

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

// ---- messages -------------------------------------------------------------------------------------------

void ViewServer::State::receive(PageConnection& page, std::string_view text) {
  try {
    act(page, parse_page_message(text));
  } catch (const std::exception& failure) {
    page.answer(told_text(false, failure.what()));
    if (!texts[PageText::scene]->empty()) page.send(PageText::scene, texts[PageText::scene]);
  }
}

void ViewServer::State::act(PageConnection& page, const PageMessage& message) {
  const std::uint32_t before = edits.revision();
  if (const auto* set = std::get_if<SetValues>(&message)) edits.set(*set);
  if (std::holds_alternative<Undo>(message)) edits.undo();
  if (std::holds_alternative<Redo>(message)) edits.redo();
  if (std::holds_alternative<Reset>(message)) edits.reset();
  if (const auto* restore = std::get_if<Restore>(&message))
    if (const std::string lost = edits.restore(restore->edits); !lost.empty())
      page.answer(told_text(false, "not restored, as the view cannot change files: " + lost));
  if (const auto* files = std::get_if<OpenFiles>(&message)) open(page, *files);
  if (const auto* save_as = std::get_if<SaveScene>(&message)) save(page, save_as->name);
  if (const auto* file = std::get_if<RenderFile>(&message)) render_file(page, file->name);
  if (const auto* layer = std::get_if<ChooseLayer>(&message)) {
    page.choose_layer(layer->name);
    if (picture != nullptr) page.send(picture);
    if (reference != nullptr) page.send(reference);
  }
  if (const auto* wanted = std::get_if<WorkBehind>(&message)) work_behind(*wanted);
  if (const auto* choice = std::get_if<ChooseSettings>(&message)) {
    asked.target_error = choice->error;
    background->ask(asked);
    page.answer(told_text(true, fmt::format("choosing settings for {:.3g} %", 100 * choice->error)));
  }
  if (const auto* frame = std::get_if<GoToFrame>(&message)) edits.go_to_frame(frame->frame);
  if (const auto* look = std::get_if<LookFrom>(&message)) edits.look(*look);
  if (std::holds_alternative<LookBack>(message)) edits.look_back();
  if (std::holds_alternative<KeepLook>(message)) edits.keep_look();
  if (const auto* lights = std::get_if<ChangeLights>(&message)) edits.change_lights(*lights);
  if (const auto* place = std::get_if<Pick>(&message)) pick(page, *place);
  if (const auto* shown = std::get_if<FrameShown>(&message)) page.shown(shown->frame);
  if (edits.revision() != before) after_edit();
}

void ViewServer::State::work_behind(const WorkBehind& wanted) {
  asked = {wanted.trade, {}, {}};
  if (!wanted.reference.empty())
    asked.reference = wanted.reference == name_of(Method::volume) ? Method::volume : Method::direct;
  background->ask(asked);
  if (!asked.reference) reference.reset();
  tell(PageText::behind, behind_text(wanted));
}

/// Applies chosen settings as an edit; if the scene has changed meanwhile, chooses again.
void ViewServer::State::take(const ChosenSettings& chosen) {
  if (chosen.revision != edits.revision() || !asked.target_error) return;
  const double target = *std::exchange(asked.target_error, {});
  background->ask(asked);
  SetValues values;
  for (const std::string& text : chosen.overrides) {
    const std::size_t end_of_path = text.find('=');
    values.values.push_back({text.substr(0, end_of_path), text.substr(end_of_path + 1)});
  }
  std::string answer = told_choice(target, chosen.outcome);
  try {
    if (chosen.outcome.sees_translucent) edits.set(values);
  } catch (const Error& failure) {
    answer = told_text(false, failure.what());
  }
  for (PageConnection* page : pages) page->answer(answer);
  if (edits.revision() != chosen.revision) after_edit();
}

void ViewServer::State::after_edit(bool has_new_files) {
  background->stop();
  reference.reset();
  renderer->show(edits.scene(), edits.revision(), edits.reference(), has_new_files);
  watch.watch(edits.files());
  tell(PageText::scene, scene_text(edits, hooks.command(edits.file(), edits.overrides(), edits.frame())));
  if (!std::exchange(shows_progress, true)) show_progress();
}

/// An asset replaces the scene; an environment map alone replaces its lights.
void ViewServer::State::open(PageConnection& page, const OpenFiles& files) {
  const std::string path = dropped.take(files.drop, files.names);
  try {
    if (are_files_outside_assets_allowed())
      throw bad_file(path, "is not opened", "a view without --allow-outside: pages would read any file");
    if (is_environment_name(path))
      edits.light_by(path);
    else
      edits.open(path);
  } catch (const std::exception&) {
    dropped.discard(path);
    throw;
  }
  page.answer(told_text(true, "opened " + path));
}

/// Files of the scene have changed on the disk. Stages are reused if none of them is a mesh.
void ViewServer::State::reload(const std::set<std::string>& files) {
  changed_files.insert(files.begin(), files.end());
  std::string answer;
  try {
    const std::string lost = edits.reload();
    answer = told_text(lost.empty(), "opened " + edits.file() + " again" +
                                         (lost.empty() ? "" : ", without its edits: " + lost));
    after_edit(is_asset_name(edits.file()) || changed_files != std::set{edits.file()});
    changed_files.clear();
  } catch (const std::exception& failure) {
    answer = told_text(false, failure.what());
  }
  for (PageConnection* page : pages) page->answer(answer);
}

/// Interrupts a final image: it may take long.
void ViewServer::State::pick(PageConnection& page, const Pick& place) {
  const Film& film = edits.scene().film;
  const Rectangle part = rendered_part(film);
  if (place.x >= part.x1 - part.x0 || place.y >= part.y1 - part.y0) return;
  picking = &page;
  renderer->pick(part.x0 + place.x, part.y0 + place.y);
  if (renderer->can_interrupt()) renderer->show(edits.scene(), edits.revision(), edits.reference());
}

/// Note on written files differing from the view.
std::string ViewServer::State::by_scene_camera() const {
  return edits.own_camera() ? ", with the scene camera" : "";
}

void ViewServer::State::save(PageConnection& page, const std::string& name) {
  const std::string path = path_beside(edits.file(), name, {".json"}, written);
  write_file(path, edits.file_text());
  written.insert(path);
  page.answer(told_text(true, "saved " + path + by_scene_camera()));
}

void ViewServer::State::render_file(PageConnection& page, const std::string& name) {
  const std::optional<int> frame = edits.frame();
  std::string numbered = name;
  if (frame && name.find("##") == std::string::npos)
    numbered.insert(name.size() - std::filesystem::path(name).extension().string().size(), ".####");
  const std::string path =
      path_beside(edits.file(), frame ? with_frame(numbered, *frame) : name, {".exr", ".png"}, written);
  const std::string pattern = frame ? (std::filesystem::path(path).parent_path() / numbered).string() : path;
  if (renders_file) throw bad_file(path, "another file is being rendered", "one render at a time");
  file_thread =
      std::jthread([this, path, pattern, frame, scene = edits.file(), overrides = edits.overrides()] {
        std::string failure;
        try {
          hooks.render_file(scene, overrides, frame, pattern, file_monitor);
        } catch (const std::exception& error) {
          failure = error.what();
        }
        asio::post(io, [this, path, failure] {
          renders_file = false;
          if (failure.empty()) written.insert(path);
          const std::string text = failure.empty() ? "rendered " + path : path + ": " + failure;
          for (PageConnection* shown : pages) shown->answer(told_text(failure.empty(), text));
        });
      });
  renders_file = true;
  page.answer(told_text(true, "rendering " + path + by_scene_camera()));
}

// ---- events of the renderer, and the timer ----------------------------------------------------------------

ViewEvents ViewServer::State::renderer_events() {
  return {[this](std::uint32_t revision, const Scene& scene, const Plan& plan) {
            asio::post(io, [this, text = plan_text(revision, scene, plan)] { tell(PageText::plan, text); });
          },
          [this](std::shared_ptr<const ViewPicture> news) {
            asio::post(io, [this, news = std::move(news)] {
              picture = news;
              packed.clear();
              for (PageConnection* page : pages) page->send(picture);
            });
          },
          [this](const ViewReport& report) {
            asio::post(io, [this, text = report_text(report), revision = report.revision] {
              tell(PageText::report, text);
              if (revision == edits.revision() && picture->revision == revision)
                background->start(edits.scene(), picture);
            });
          },
          [this](std::uint32_t revision, const std::string& why) {
            asio::post(io, [this, text = failed_text(revision, why)] { tell(PageText::failed, text); });
          },
          [this](std::optional<std::size_t> shape) {
            asio::post(io, [this, text = picked_text(shape)] {
              if (picking != nullptr) picking->answer(text);
            });
          }};
}

BackgroundEvents ViewServer::State::background_events() {
  return {[this](const TradeState& trade) {
            asio::post(io, [this, text = trade_text(trade)] { tell(PageText::trade, text); });
          },
          [this](std::shared_ptr<const ViewPicture> news, const ReferenceState& state) {
            asio::post(io, [this, news = std::move(news), state] {
              if (state.revision != edits.revision()) return;
              reference = news;
              tell(PageText::reference, reference_text(state));
              for (PageConnection* page : pages) page->send(reference);
            });
          },
          [this](const ChosenSettings& chosen) { asio::post(io, [this, chosen] { take(chosen); }); },
          [this](std::uint32_t revision, const std::string& why) {
            asio::post(io, [this, text = failed_text(revision, why)] {
              asked.target_error.reset();
              background->ask(asked);
              tell(PageText::failed, text);
            });
          }};
}

/// Every kTick during drawing; an idle view does not wake up.
void ViewServer::State::show_progress() {
  renderer->end_stale_work();
  shows_progress = renderer->is_drawing();
  std::string work = work_text(renderer->monitor());
  const SharedText& last = texts[PageText::work];
  if (last == nullptr || *last != work) tell(PageText::work, std::move(work));
  if (!shows_progress) return;
  timer.expires_after(kTick);
  timer.async_wait([this](error_code) { show_progress(); });
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
