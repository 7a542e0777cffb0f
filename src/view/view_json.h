// SPDX-License-Identifier: GPL-3.0-or-later
// Messages to the pages, each a JSON text with the member "is".
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "opaline/monitor.h"
#include "view/scene_edits.h"
#include "view/view_background.h"
#include "view/view_renderer.h"

namespace opaline {

/// "schema": keys with unit, range, default, meaning and choices, and presets of media, for the knobs.
std::string schema_text();

/// "scene": all values, the free camera, the edits, availability of undo and redo, and the frames.
/// in    command: renders the same from the scene's camera; environments: names of environment maps offered
std::string scene_text(const SceneEdits& edits, const std::string& command,
                       const std::vector<std::string>& environments);

/// "plan": requirements of the scene, in words, and the bounds of its shapes in scene units.
/// in    boxes: one per shape, mm
std::string plan_text(std::uint32_t revision, const Scene& scene, const Plan& plan,
                      std::span<const Bounds> boxes);

/// "report": on a final image.
std::string report_text(const ViewReport& report);

/// "behind": requested background work.
std::string behind_text(const WorkBehind& wanted);

/// "trade": the points so far, each with its settings as in `--set`.
std::string trade_text(const TradeState& trade);

/// "reference": its progress, and the final image's difference from it.
std::string reference_text(const ReferenceState& state);

/// "work": the running stage and its progress; an empty stage if idle.
std::string work_text(const Monitor& monitor);

/// "file": progress of the image rendered to a file; an empty stage without one.
std::string file_text(const Monitor& monitor, bool is_rendered);

/// "failed": a change without an image. "told": an answer to one page; `good`: the request succeeded.
std::string failed_text(std::uint32_t revision, const std::string& why);
std::string told_text(bool good, const std::string& text);

/// "picked": the index of a shape, or null.
std::string picked_text(std::optional<std::size_t> shape);

/// "told": the settings chosen for an error.
std::string told_choice(double target, const TargetError& chosen);

}  // namespace opaline
