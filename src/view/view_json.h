// SPDX-License-Identifier: GPL-3.0-or-later
// Messages to the pages, each a JSON text with the member "is".
#pragma once

#include <cstdint>
#include <string>

#include "opaline/monitor.h"
#include "view/scene_edits.h"
#include "view/view_background.h"
#include "view/view_renderer.h"

namespace opaline {

/// "schema": the table of keys with unit, range, default, meaning and choices, and the presets of media: what
/// knobs are made of.
std::string schema_text();

/// "scene": all values, the view's own camera, the edits, whether there is a way back, and the frames.
/// command: that renders the same by the scene's camera.
std::string scene_text(const SceneEdits& edits, const std::string& command);

/// "plan": what the scene requires, in words.
std::string plan_text(std::uint32_t revision, const Scene& scene, const Plan& plan);

/// "report": of a final picture.
std::string report_text(const ViewReport& report);

/// "behind": what is asked to be worked out behind the final picture.
std::string behind_text(const WorkBehind& wanted);

/// "trade": the points so far; each with the values that take it, as `--set` names them.
std::string trade_text(const TradeState& trade);

/// "reference": how far it is, and what the final picture differs from it by.
std::string reference_text(const ReferenceState& state);

/// "work": which stage is under way, and how much of it is done; the stage is empty while nothing is.
std::string work_text(const Monitor& monitor);

/// "failed": a change that has no picture. "told": an answer to one page; `good`: it did what it was asked.
std::string failed_text(std::uint32_t revision, const std::string& why);
std::string told_text(bool good, const std::string& text);

/// "told": what was chosen for an error.
std::string told_choice(double target, const TargetError& chosen);

}  // namespace opaline
