// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of a page.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace opaline {

/// A value of the scene: a path as of `--set`, and JSON.
struct Assignment {
  std::string path, value;
};

/// stroke: changes of one number other than 0 are one step for undo, as those of a slider that is dragged.
struct SetValues {
  std::vector<Assignment> values;
  std::uint64_t stroke = 0;
};
struct Undo {};
struct Redo {};
struct Reset {};
/// Edits of a page whose server is new: as `--set` takes them.
struct Restore {
  std::vector<std::string> edits;
};
struct SaveScene {
  std::string name;
};
struct RenderFile {
  std::string name;
};
/// The layer that frames bring beside R G B A; empty: none.
struct ChooseLayer {
  std::string name;
};
/// Background work behind the final image, for all pages.
struct WorkBehind {
  bool trade = false;
  std::string reference;  ///< "direct", "volume" or none
};
/// Settings for an error, relative, > 0 and < 1.
struct ChooseSettings {
  double error = 0;
};
/// The frame of this number is on the screen.
struct FrameShown {
  std::uint32_t frame = 0;
};
/// The scene as it is at this frame of a range.
struct GoToFrame {
  int frame = 1;
};
/// A camera of the view's own in place of the scene's: JSON as camera.position and camera.look_at take it.
struct LookFrom {
  std::string position, look_at;
};
/// The scene's camera again.
struct LookBack {};
/// The view's own camera becomes the scene's.
struct KeepLook {};

using PageMessage =
    std::variant<SetValues, Undo, Redo, Reset, Restore, SaveScene, RenderFile, ChooseLayer, WorkBehind,
                 ChooseSettings, FrameShown, GoToFrame, LookFrom, LookBack, KeepLook>;

/// in    text: {"do": "set", "values": {"media.marble.specular_ior": 1.4}, "stroke": 7}, {"do": "undo"}, {"do": "redo"},
///       {"do": "reset"}, {"do": "restore", "edits": ["media.marble.specular_ior=1.4"]}, {"do": "save", "name": "a.json"},
///       {"do": "render", "name": "a.exr"}, {"do": "layer", "name": "N"},
///       {"do": "behind", "trade": true, "reference": "direct"}, {"do": "choose", "error": 0.01},
///       {"do": "frame", "frame": 7}, {"do": "shown", "frame": 3},
///       {"do": "look", "position": [0, 0, 5], "look_at": [0, 0, 0]}, {"do": "look_back"} or {"do": "keep_look"}
/// error Error{bad_input}: no such message, within the limits of json_tree.h
PageMessage parse_page_message(std::string_view text);

}  // namespace opaline
