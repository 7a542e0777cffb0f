// SPDX-License-Identifier: GPL-3.0-or-later
// The models' errors against random walks, by shape and medium.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// Radiant exitance of a session's only body, prepared, at places of its surface, as its method has it there.
std::vector<RgbF> exitance_at(const Session& session, std::span<const SurfaceSample> places);

/// Prints the table of models in Markdown. Scenes and truths are made in the folder where they are missing, and kept: a
/// run that was stopped goes on after the last pair that was complete.
/// error Error{bad_output} where the folder cannot be written
void print_model_table(const std::string& folder);

/// Prints quality and cost of the default image in Markdown: `auto` with re-entry, against random walks with re-entry.
/// in    meshes_and_parts: paths of more shapes, scaled to 50 mm, their holes filled, and parts of "shape medium": rows
///       without one of these are left out
/// error Error{bad_input}: neither a file nor part of a row; else as print_model_table; as load_scene and make_mesh for the meshes
void print_default_table(const std::string& folder, std::span<const std::string> meshes_and_parts);

/// Prints the errors of one model channel by channel, from the same scenes and truths.
/// in    name: a column of the table; choices: of the model's settings KEY=VALUE, not of the truth's, and parts of
///       "shape medium", of which those that are printed have one
/// error Error{bad_input}: no such model; else as print_model_table
void print_model_channels(const std::string& folder, const std::string& name,
                          const std::vector<std::string>& choices);

}  // namespace opaline
