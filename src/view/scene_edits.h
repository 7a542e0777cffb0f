// SPDX-License-Identifier: GPL-3.0-or-later
// A scene under edit: the file as it was opened, the values that were changed since, and the way back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "opaline/scene/scene.h"
#include "view/page_message.h"

namespace opaline {

/// A larger picture is refused, pixels.
inline constexpr std::size_t kMostViewPixels = std::size_t(1) << 24;

class SceneEdits {
 public:
  /// given: overrides of the command line, which no undo takes back
  /// frames: that can be gone to, rising; empty: from the first key to the last of values that change, if there are any
  /// error as load_scene; Error{bad_input}: more than kMostViewPixels
  SceneEdits(const std::string& file, std::vector<std::string> given, std::vector<int> frames = {});

  // Each changes the scene or throws and changes nothing. What changes nothing does not count as a step.
  // error as parse_scene; Error{bad_input}: more than kMostViewPixels, or other mesh files than the opened scene's

  /// A value that has keys gets one at the frame that is shown and keeps the others. The camera's position or point of
  /// interest ends the view's own camera.
  void set(const SetValues& message);
  void undo();
  void redo();
  void reset();
  /// Does nothing where the scene has been edited before.
  void restore(const std::vector<std::string>& edits);

  /// Shows another frame; that is no step of undo.
  /// error as parse_scene; Error{bad_input}: none of frames()
  void go_to_frame(int frame);

  // The view's own camera: no edit, no step of undo, and in no file.
  // error as parse_scene
  void look(const LookFrom& look);
  void look_back();
  /// An edit of the scene's camera, as `set` makes it.
  void keep_look();

  /// Empty: the scene has none, and is shown as it is at frame 1.
  const std::vector<int>& frames() const { return frames_; }
  /// The one that is shown, where there are any.
  std::optional<int> frame() const;
  /// The scene at settings.reference_frame, on whose surfaces samples are placed, where there are frames.
  std::optional<Scene> reference() const;

  /// By the view's own camera, where it has one.
  const Scene& scene() const { return scene_; }
  const std::optional<LookFrom>& own_camera() const { return look_; }
  const std::string& file() const { return file_; }
  /// Counts changes, from 1.
  std::uint32_t revision() const { return revision_; }
  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < history_.size(); }
  /// As `--set` takes them, without those of the command line.
  const std::vector<std::string>& edits() const { return history_[at_]; }
  std::vector<std::string> overrides() const;

  /// All of the scene's values as JSON, those that change as in the frame that is shown.
  std::string json() const;
  /// The scene file with the edits in it: what they leave alone stays as it is written, comments too.
  std::string file_text() const;

 private:
  using Edits = std::vector<std::string>;
  using Look = std::optional<LookFrom>;
  Scene parsed(const Edits& edits, const Look& look) const;
  Scene read(const Edits& edits, const Look& look, int frame) const;
  Assignment with_key(const Assignment& change) const;
  void go_to(std::size_t place);

  std::string file_, text_;
  Edits given_;
  std::vector<Edits> history_{Edits{}};
  std::size_t at_ = 0;
  std::uint64_t stroke_ = 0;  // stroke of the last step; 0: closed
  std::uint32_t revision_ = 1;
  std::vector<int> frames_;
  int frame_ = 1;
  Look look_;
  Scene scene_;
};

}  // namespace opaline
