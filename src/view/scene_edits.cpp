// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/scene_edits.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>
#include <utility>

#include "core/log.h"
#include "input/load_scene.h"
#include "input/overrides.h"
#include "input/schema.h"
#include "opaline/error.h"
#include "view/edit_paths.h"
#include "view/keyed_values.h"

namespace opaline {
namespace {

constexpr int kMostKeyedFrames = 100000;

std::vector<std::string> mesh_files(const Scene& scene) {
  std::vector<std::string> files;
  for (const Shape& shape : scene.shapes)
    if (const auto* mesh = std::get_if<MeshFile>(&shape.source)) files.push_back(mesh->path);
  return files;
}

void check_pixels(const Scene& scene) {
  const Film& film = scene.film;
  const auto [x0, y0, x1, y1] = film.crop.value_or(std::array{0, 0, film.resolution[0], film.resolution[1]});
  const std::size_t pixels = std::size_t(x1 - x0) * std::size_t(y1 - y0);
  if (pixels > kMostViewPixels)
    throw bad_file(
        {}, "'film.resolution' is too large for the view",
        "at most " + std::to_string(kMostViewPixels) + " pixels, or a 'film.crop' of at most as many",
        std::to_string(pixels));
}

/// True if a value of this path places the scene's camera.
bool moves_camera(const std::string& path) {
  return path == "camera" || path.starts_with("camera.position") || path.starts_with("camera.look_at");
}

/// Removes edits of a shape's opaque surface, replaced by a medium, and vice versa.
void drop_replaced_surface(std::vector<std::string>& edits, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (!path.starts_with("shapes.") || dot == path.npos) return;
  for (const std::string_view key : replaced_surface_keys(path.substr(dot + 1)))
    std::erase_if(edits, [&](const std::string& edit) {
      return is_within(edit, path.substr(0, dot + 1) + std::string(key));
    });
}

}  // namespace

SceneEdits::SceneEdits(const std::string& file, std::vector<std::string> given, std::vector<int> frames)
    : file_(file), given_(std::move(given)), frames_(frames), given_frames_(std::move(frames)) {
  if (is_asset_name(file)) {
    ImportedAsset asset = import_asset(file, std::filesystem::path(file).filename().string());
    placed_ = placed_defaults(asset, file, given_);
    text_ = std::move(asset.text);
  } else {
    text_ = read_scene_text(file);
  }
  if (!frames_.empty()) frame_ = frames_.front();
  scene_ = read({}, {}, frame_);
  if (!frames_.empty()) return;
  const std::set<int> keys = key_frames(Json::parse(merged_scene(text_, file_, all_overrides({}))));
  if (keys.empty()) return;
  const int first = *keys.begin(), last = *keys.rbegin();
  if (last <= first || last - first >= kMostKeyedFrames) return;
  frames_.resize(std::size_t(last - first + 1));
  std::iota(frames_.begin(), frames_.end(), first);
  go_to_frame(first);
  revision_ = 1;
}

/// True for edits opening files: by their key, or by an object with one, in any spelling.
bool SceneEdits::opens_file(const std::string& edit) const {
  if (std::ranges::find(with_files_, edit) != with_files_.end()) return false;
  const std::size_t end = edit.find('=');
  const std::string path = '.' + edit.substr(0, end), value = end < edit.size() ? edit.substr(end + 1) : "";
  const bool hides_keys = path.find_first_of("\"'") != std::string::npos;  // by quotes
  return hides_keys || value.find('\\') != std::string::npos ||
         std::ranges::any_of(file_keys(), [&](std::string_view key) {
           return path.ends_with('.' + std::string(key)) ||
                  value.find('"' + std::string(key) + '"') != std::string::npos;
         });
}

Scene SceneEdits::parsed(const Edits& edits, const Look& look) const {
  if (std::ranges::any_of(edits, [&](const std::string& edit) { return opens_file(edit); }))
    throw bad_file(file_, "the view cannot change files", "the files of the opened scene");
  Scene scene = read(edits, look, frame_);
  if (mesh_files(scene) != mesh_files(scene_))
    throw bad_file(file_, "the view cannot change mesh files", "the files of the opened scene");
  return scene;
}

/// Parses with the scene's own camera as well: a free camera must not hide an invalid edit.
Scene SceneEdits::read(const Edits& edits, const Look& look, int frame) const {
  Edits all = all_overrides(edits);
  Scene scene = parse_scene(text_, file_, all, frame);
  check_pixels(scene);
  if (!look) return scene;
  all.push_back("camera.position=" + look->position);
  all.push_back("camera.look_at=" + look->look_at);
  return parse_scene(text_, file_, all, frame);
}

void SceneEdits::set(const SetValues& message) {
  change(message, true);
}

/// at_frame: keyed values get a key at the frame, instead of one value
void SceneEdits::change(const SetValues& message, bool at_frame) {
  Edits edits = history_.edits();
  Look look = look_;
  for (const Assignment& given : message.values) {
    if (moves_camera(given.path)) look.reset();
    const Assignment change = at_frame ? with_key(given) : given;
    if (!change.path.ends_with(".+"))
      std::erase_if(edits, [&](const std::string& text) { return is_within(text, change.path); });
    drop_replaced_surface(edits, change.path);
    edits.push_back(change.path + '=' + change.value);
  }
  if (edits == history_.edits()) return;
  Scene scene = parsed(edits, look);
  look_ = std::move(look);
  const bool goes_on = message.stroke != 0 && message.stroke == stroke_;
  if (goes_on) {
    history_.replace(std::move(edits));
  } else {
    push(std::move(edits));
  }
  stroke_ = message.stroke;
  scene_ = std::move(scene);
  ++revision_;
}

/// Adds a step of undo.
void SceneEdits::push(Edits edits) {
  history_.push(std::move(edits));
  stroke_ = 0;
}

/// Replaces all edits, as a step.
void SceneEdits::replace(Edits all) {
  if (all == edits()) return;
  scene_ = parsed(all, look_);
  push(std::move(all));
  ++revision_;
}

void SceneEdits::go_to(std::size_t place) {
  scene_ = parsed(history_.edits_at(place), look_);
  history_.go_to(place);
  stroke_ = 0;
  ++revision_;
}

void SceneEdits::undo() {
  if (can_undo()) go_to(history_.place() - 1);
}

void SceneEdits::redo() {
  if (can_redo()) go_to(history_.place() + 1);
}

void SceneEdits::reset() {
  replace({});
}

std::string SceneEdits::restore(const std::vector<std::string>& edits) {
  if (revision_ > 1 || edits.empty()) return {};
  Edits kept, before;  // before: edits before the lost one
  std::string lost;
  for (const std::string& edit : edits)
    if (!opens_file(edit)) {
      kept.push_back(edit);
      if (lost.empty()) before.push_back(edit);
    } else if (lost.empty()) {
      lost = edit;
    }
  try {
    scene_ = parsed(kept, look_);
  } catch (const Error&) {
    if (lost.empty()) throw;
    kept = std::move(before);  // a later one refers to the lost one
    scene_ = parsed(kept, look_);
  }
  push(std::move(kept));
  ++revision_;
  return lost;
}

void SceneEdits::open(const std::string& file) {
  Edits kept = given_;
  std::erase_if(kept, [](const std::string& edit) {
    return !edit.starts_with("film.") && !edit.starts_with("settings.");
  });
  SceneEdits opened(file, std::move(kept));
  opened.revision_ = revision_ + 1;
  *this = std::move(opened);
}

std::string SceneEdits::reload() {
  SceneEdits opened(file_, given_, given_frames_);
  opened.with_files_ = with_files_;
  opened.history_ = history_;
  std::string lost;
  try {
    if (std::ranges::find(opened.frames_, frame_) != opened.frames_.end()) opened.frame_ = frame_;
    opened.scene_ = opened.parsed(edits(), look_);
    opened.look_ = look_;
  } catch (const Error& failure) {
    lost = failure.what();
    opened.history_.push({});
    opened.scene_ = opened.read({}, {}, opened.frame_);
  }
  opened.revision_ = revision_ + 1;
  *this = std::move(opened);
  return lost;
}

std::vector<std::string> SceneEdits::files() const {
  std::vector<std::string> files = mesh_files(scene_);
  files.push_back(file_);
  return files;
}

void SceneEdits::light_by(const std::string& picture) {
  SetValues values;
  for (const std::string& edit : environment_overrides(picture)) {
    const std::size_t end = edit.find('=');
    values.values.push_back({edit.substr(0, end), edit.substr(end + 1)});
    with_files_.push_back(edit);
  }
  change(values, false);
}

void SceneEdits::go_to_frame(int frame) {
  if (std::ranges::find(frames_, frame) == frames_.end())
    throw bad_file(file_, "frame " + std::to_string(frame) + " is not shown",
                   frames_.empty() ? "a scene with frames (--frames)"
                                   : "one from " + std::to_string(frames_.front()) + " to " +
                                         std::to_string(frames_.back()) + " of --frames");
  if (frame == frame_) return;
  scene_ = read(edits(), look_, frame);
  frame_ = frame;
  stroke_ = 0;
  ++revision_;
}

void SceneEdits::look(const LookFrom& look) {
  scene_ = parsed(edits(), look);
  look_ = look;
  ++revision_;
}

void SceneEdits::look_back() {
  if (!look_) return;
  scene_ = parsed(edits(), {});
  look_.reset();
  ++revision_;
}

std::optional<int> SceneEdits::frame() const {
  return frames_.empty() ? std::nullopt : std::optional(frame_);
}

std::optional<Scene> SceneEdits::reference() const {
  if (frames_.empty()) return {};
  return parse_scene(text_, file_, all_overrides(edits()), scene_.settings.reference_frame);
}

SceneEdits::Edits SceneEdits::all_overrides(const Edits& edits) const {
  Edits all = placed_;
  all.insert(all.end(), given_.begin(), given_.end());
  for (const std::string& edit : edits) drop_replaced_surface(all, edit.substr(0, edit.find('=')));
  all.insert(all.end(), edits.begin(), edits.end());
  return all;
}

// Without edits of the camera or sizes, the command places the defaults as placed_.
std::vector<std::string> SceneEdits::overrides() const {
  const auto may_place = [](const std::string& edit) {
    return edit.find("camera") != edit.npos || edit.find("fit_size") != edit.npos;
  };
  Edits all = all_overrides(edits());
  if (std::ranges::none_of(edits(), may_place))
    all.erase(all.begin(), all.begin() + std::ptrdiff_t(placed_.size()));
  return all;
}

std::string SceneEdits::json() const {
  return merged_scene(text_, file_, all_overrides(edits()), frame_);
}

/// JSON with all keys.
std::string SceneEdits::whole() const {
  return merged_scene(text_, file_, all_overrides(edits()));
}

std::string SceneEdits::file_text() const {
  return edited_scene(text_, file_, all_overrides(edits()));
}

}  // namespace opaline
