// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of the pages.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <filesystem>
#include <utility>

#include "asset_files/asset_file.h"
#include "core/atomic_file.h"
#include "input/load_scene.h"
#include "opaline/error.h"
#include "render/render.h"
#include "scene/names.h"
#include "values/frame_name.h"
#include "values/json_tree.h"
#include "view/environments.h"
#include "view/view_json.h"
#include "view/view_server_state.h"

namespace opaline {
namespace {

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
void ViewServer::State::receive(PageConnection& page, std::string_view text) {
  try {
    act(page, parse_page_message(text));
  } catch (const std::exception& failure) {
    page.answer(told_text(false, failure.what()));
    if (!texts[PageText::scene]->empty()) page.send(PageText::scene, texts[PageText::scene]);
  }
}

/// Messages with an effect on the edits alone.
void ViewServer::State::change_scene(const PageMessage& message) {
  if (const auto* set = std::get_if<SetValues>(&message)) edits.set(*set);
  if (std::holds_alternative<Undo>(message)) edits.undo();
  if (std::holds_alternative<Redo>(message)) edits.redo();
  if (std::holds_alternative<Reset>(message)) edits.reset();
  if (const auto* recall = std::get_if<Recall>(&message)) edits.recall(recall->edits);
  if (const auto* frame = std::get_if<GoToFrame>(&message)) edits.go_to_frame(frame->frame);
  if (const auto* look = std::get_if<LookFrom>(&message)) edits.look(*look);
  if (std::holds_alternative<LookBack>(message)) edits.look_back();
  if (std::holds_alternative<KeepLook>(message)) edits.keep_look();
  if (std::holds_alternative<KeyLook>(message)) edits.key_look();
  if (const auto* lights = std::get_if<ChangeLights>(&message)) edits.change_lights(*lights);
  if (const auto* names = std::get_if<RenameMedium>(&message)) edits.rename_medium(*names);
  if (const auto* floor = std::get_if<SetFloor>(&message)) set_floor(floor->is_on);
}

void ViewServer::State::act(PageConnection& page, const PageMessage& message) {
  const std::uint32_t before = edits.revision();
  change_scene(message);
  if (const auto* restore = std::get_if<Restore>(&message))
    if (const std::string lost = edits.restore(restore->edits); !lost.empty())
      page.answer(told_text(false, "not restored, as the view cannot change files: " + lost));
  if (const auto* files = std::get_if<OpenFiles>(&message)) open(page, *files);
  if (const auto* map = std::get_if<LightBy>(&message)) light_by(map->name);
  if (const auto* save_as = std::get_if<SaveScene>(&message)) save(page, save_as->name);
  if (const auto* file = std::get_if<RenderFile>(&message)) render_file(page, file->name);
  if (std::holds_alternative<CancelFile>(message)) file_monitor.cancelled = true;
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
  find_environments();
  std::vector<std::string> names;
  for (const auto& [name, path] : environments) names.push_back(name);
  tell(PageText::scene,
       scene_text(edits, hooks.command(edits.file(), edits.overrides(), edits.frame()), names));
  if (!std::exchange(shows_progress, true)) show_progress();
}

/// An asset replaces the scene; an environment map alone replaces its lights.
void ViewServer::State::open(PageConnection& page, const OpenFiles& files) {
  const std::string path = dropped.take(files.drop, files.names);
  try {
    if (are_files_outside_assets_allowed())
      throw bad_file(path, "is not opened", "a view without --allow-outside: pages would read any file");
    if (is_environment_name(path)) {
      edits.light_by(path);
    } else {
      edits.open(path);
      boxes.clear();
      first_revision = edits.revision();
    }
  } catch (const std::exception&) {
    dropped.discard(path);
    throw;
  }
  page.answer(told_text(true, "opened " + path));
}

void ViewServer::State::light_by(const std::string& name) {
  const auto found = environments.find(name);
  if (found == environments.end())
    throw bad_file(edits.file(), "no environment map of this name is offered", "a name from the list",
                   "'" + printable(name) + "'");
  edits.light_by(found->second);
}

/// Environment maps beside the scene, and where the view began.
void ViewServer::State::find_environments() {
  const auto folder_of = [](const std::string& path) {
    return std::filesystem::path(path).parent_path().string();
  };
  if (edits.file() == offered_for) return;
  offered_for = edits.file();
  if (first_folder.empty()) first_folder = folder_of(edits.file());
  const std::string folder = folder_of(edits.file());
  environments = folder == first_folder ? environments_in({folder}) : environments_in({folder, first_folder});
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

void ViewServer::State::set_floor(bool is_on) {
  if (!is_on) return edits.remove_floor();
  Bounds all;
  for (const Bounds& box : boxes) {
    all.low = component_min(all.low, box.low);
    all.high = component_max(all.high, box.high);
  }
  if (boxes.size() != edits.scene().shapes.size() || boxes.empty())
    throw bad_file(edits.file(), "a floor cannot be added yet", "the first image of the shapes");
  edits.add_floor(all.low, all.high);
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
  file_monitor.begin("loading", 0);
  file_monitor.cancelled = false;
  file_thread =
      std::jthread([this, path, pattern, frame, scene = edits.file(), overrides = edits.overrides()] {
        std::string failure;
        try {
          hooks.render_file(scene, overrides, frame, pattern, file_monitor);
        } catch (const std::exception& error) {
          failure = error.what();
        }
        boost::asio::post(io, [this, path, failure] {
          renders_file = false;
          if (failure.empty()) written.insert(path);
          const std::string text = failure.empty() ? "rendered " + path : path + ": " + failure;
          for (PageConnection* shown : pages) shown->answer(told_text(failure.empty(), text));
        });
      });
  renders_file = true;
  if (!std::exchange(shows_progress, true)) show_progress();
  page.answer(told_text(true, "rendering " + path + by_scene_camera()));
}

}  // namespace opaline
