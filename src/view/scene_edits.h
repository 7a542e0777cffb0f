// SPDX-License-Identifier: GPL-3.0-or-later
// A scene under edit: the opened file, the changed values, and undo.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "opaline/scene.h"
#include "view/edit_history.h"
#include "view/page_message.h"

namespace opaline {

/// Maximum number of pixels of an image.
inline constexpr std::size_t kMostViewPixels = std::size_t(1) << 24;

class SceneEdits {
 public:
  /// given: overrides of the command line, not subject to undo
  /// frames: selectable frames, ascending; empty: from the first key to the last of keyed values, if any
  /// error as load_scene; Error{bad_input}: more than kMostViewPixels
  SceneEdits(const std::string& file, std::vector<std::string> given, std::vector<int> frames = {});

  // Each changes the scene, or throws without a change. An edit without a change is not a step of undo.
  // error as parse_scene; Error{bad_input}: more than kMostViewPixels, or other mesh files than the opened
  //       scene's

  /// A keyed value gets a key at the current frame and keeps the others. An edit of the camera position or
  /// point of interest ends the free camera.
  void set(const SetValues& message);
  void undo();
  void redo();
  void reset();
  /// No effect after an edit of the scene. Returns the first edit left out because it names a file, if any.
  std::string restore(const std::vector<std::string>& edits);

  /// Other edits, as one step.
  /// error Error{bad_input}: an edit names a file, and was not made here
  void recall(const std::vector<std::string>& edits) { replace(edits); }

  /// Opens another file without edits; command-line overrides of film and settings stay.
  /// error as the constructor
  void open(const std::string& file);
  /// Reads the file again, as its change on the disk left it. If the edits no longer fit, they are undone as a step;
  /// returns the reason.
  /// error as the constructor, without a change
  std::string reload();
  /// Files of the scene: itself and its meshes.
  std::vector<std::string> files() const;
  /// An environment map replacing all lights: an edit.
  void light_by(const std::string& picture);

  /// An edit of the list of lights; keyed values keep their keys. A new light is above the camera's point of interest.
  /// error Error{bad_input}: no light of this index
  void change_lights(const ChangeLights& wanted);

  /// An edit of the media, and of all references to the one with the name.
  /// error Error{bad_input}: no such medium; an invalid name, or one of another medium
  void rename_medium(const RenameMedium& wanted);

  // An edit: a diffuse square just below everything; and its removal, with the edits of it.
  /// in    low, high: bounds of the scene, mm
  void add_floor(const Vec3d& low, const Vec3d& high);
  void remove_floor();
  /// True while there is a floor made by add_floor.
  bool has_floor() const;

  /// Shows another frame; not a step of undo.
  /// error as parse_scene; Error{bad_input}: none of frames()
  void go_to_frame(int frame);

  // Free camera of the view: not an edit, not a step of undo, not in files.
  // error as parse_scene
  void look(const LookFrom& look);
  void look_back();
  /// An edit of the scene's camera, as `set` makes it.
  void keep_look();
  /// An edit of the scene's camera at the current frame alone: its position and point of interest become keyed if one is,
  /// and the views at all other keys stay. No effect in a scene without frames.
  void key_look();

  /// Empty: a scene without frames, shown at frame 1.
  const std::vector<int>& frames() const { return frames_; }
  /// Current frame, if any.
  std::optional<int> frame() const;
  /// Scene at settings.reference_frame, for the placement of samples, if there are frames.
  std::optional<Scene> reference() const;

  /// Scene with the free camera, if any.
  const Scene& scene() const { return scene_; }
  const std::optional<LookFrom>& own_camera() const { return look_; }
  const std::string& file() const { return file_; }
  /// Number of changes, from 1.
  std::uint32_t revision() const { return revision_; }
  bool can_undo() const { return history_.can_undo(); }
  bool can_redo() const { return history_.can_redo(); }
  /// Edits as `--set` takes them, without those of the command line.
  const std::vector<std::string>& edits() const { return history_.edits(); }
  /// Overrides of a command making this scene from the file.
  std::vector<std::string> overrides() const;

  /// All values of the scene as JSON, keyed values at the current frame.
  std::string json() const;
  /// Scene file with the edits; unchanged parts keep their text, including comments.
  std::string file_text() const;

 private:
  using Edits = EditHistory::Edits;
  using Look = std::optional<LookFrom>;
  Scene parsed(const Edits& edits, const Look& look) const;
  Scene read(const Edits& edits, const Look& look, int frame) const;
  Edits all_overrides(const Edits& edits) const;
  bool opens_file(const std::string& edit) const;
  Assignment with_key(const Assignment& change) const;
  std::string whole() const;
  void go_to(std::size_t place);
  void push(Edits edits);
  void replace(Edits all);
  void change(const SetValues& message, bool at_frame);

  std::string file_, text_;
  Edits placed_;  // placement of an asset's default camera and lights
  Edits given_;
  Edits with_files_;  // edits made here: they may name files
  EditHistory history_;
  std::uint64_t stroke_ = 0;  // stroke of the last step; 0: closed
  std::uint32_t revision_ = 1;
  std::vector<int> frames_, given_frames_;
  int frame_ = 1;
  Look look_;
  Scene scene_;
};

}  // namespace opaline
