// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of a page.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace opaline {

/// A value of the scene: a path as in `--set`, and JSON.
struct Assignment {
  std::string path, value;
};

/// stroke: changes with the same nonzero number are one undo step, as for a dragged slider.
struct SetValues {
  std::vector<Assignment> values;
  std::uint64_t stroke = 0;
};
struct Undo {};
struct Redo {};
struct Reset {};
/// Edits of a page connecting to a new server, as in `--set`.
struct Restore {
  std::vector<std::string> edits;
};
/// Edits replacing all others, as in `--set`.
struct Recall {
  std::vector<std::string> edits;
};
/// Opens uploaded files (dropped_files.h).
struct OpenFiles {
  std::string drop;
  std::vector<std::string> names;
};
/// Replaces all lights by an environment map beside the scene (environments.h).
struct LightBy {
  std::string name;
};
struct SaveScene {
  std::string name;
};
struct RenderFile {
  std::string name;
};
/// Ends the rendering of a file.
struct CancelFile {};
/// Layer sent with R G B A; empty: none.
struct ChooseLayer {
  std::string name;
};
/// Background work after the final image, for all pages.
struct WorkBehind {
  bool trade = false;
  std::string reference;  ///< "direct", "volume" or none
};
/// Chooses settings by error, relative, in (0, 1).
struct ChooseSettings {
  double error = 0;
};
/// The frame with this number is displayed.
struct FrameShown {
  std::uint32_t frame = 0;
};
/// The scene as it is at this frame of a range.
struct GoToFrame {
  int frame = 1;
};
/// A free camera replacing the scene's: JSON as in camera.position and camera.look_at.
struct LookFrom {
  std::string position, look_at;
};
/// Returns to the scene's camera.
struct LookBack {};
/// Makes the free camera the scene's.
struct KeepLook {};
/// Makes the free camera a key of the scene's at the current frame.
struct KeyLook {};
/// Adds a light, copies or removes one.
struct ChangeLights {
  enum class Change { add, copy, remove };
  Change change = Change::add;
  int index = 0;  ///< unused to add
};
struct RenameMedium {
  std::string name, to;
};
/// Adds a floor below all shapes, or removes it.
struct SetFloor {
  bool is_on = false;
};
/// Asks for the shape at a pixel of the shown image.
struct Pick {
  int x = 0, y = 0;
};

using PageMessage =
    std::variant<SetValues, Undo, Redo, Reset, Restore, OpenFiles, LightBy, SaveScene, RenderFile,
                 ChooseLayer, WorkBehind, ChooseSettings, FrameShown, GoToFrame, LookFrom, LookBack, KeepLook,
                 ChangeLights, Pick, Recall, KeyLook, RenameMedium, SetFloor, CancelFile>;

/// in    text: {"do": "set", "values": {"media.marble.specular_ior": 1.4}, "stroke": 7}, {"do": "undo"},
///       {"do": "redo"}, {"do": "reset"}, {"do": "restore", "edits": ["media.marble.specular_ior=1.4"]},
///       {"do": "open", "drop": "7", "names": ["a.obj", "a.mtl"]}, {"do": "light_by", "name": "sky.exr"}, {"do": "save", "name": "a.json"}, {"do": "render", "name": "a.exr"}, {"do": "cancel_render"}, {"do": "layer", "name": "N"},
///       {"do": "behind", "trade": true, "reference": "direct"}, {"do": "choose", "error": 0.01}, {"do":
///       "frame", "frame": 7}, {"do": "shown", "frame": 3}, {"do": "look", "position": [0, 0, 5], "look_at":
///       [0, 0, 0]}, {"do": "look_back"}, {"do": "keep_look"}, {"do": "key_look"}, {"do": "lights", "change": "copy", "index": 1},
///       {"do": "recall", "edits": ["film.exposure=1"]}, {"do": "rename_medium", "name": "stone", "to": "gneiss"},
///       {"do": "floor", "on": true} or {"do": "pick", "x": 7, "y": 3}
/// error Error{bad_input}: no such message, within the limits of json_tree.h
PageMessage parse_page_message(std::string_view text);

}  // namespace opaline
