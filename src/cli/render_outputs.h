// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a rendering leaves.
#pragma once

#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/stages.h"
#include "opaline/image.h"
#include "session/session_records.h"

namespace opaline {

/// Reports an unwritable output before the work.
/// error Error{run_failed} naming the file
void check_writable(const RenderArguments& arguments);

/// error Error{bad_input}: an output is a file that the scene was read from
void check_outputs_are_no_inputs(const RenderArguments& arguments, const Scene& scene);

/// EXR or PNG, as the name ends.
/// error as write_exr
WriteReport write_picture(const std::string& path, const Image& image, const Film& film,
                          const LayerChoice& layers);

/// error Error{bad_input}: a layer was named that this scene's picture does not have
void check_layers(const LayerChoice& layers, const Scene& scene);

/// Asked layer bytes of the layers that are made only where they are asked for.
std::size_t asked_layer_bytes(const LayerChoice& layers, const Scene& scene);
/// Makes them, each a stage.
/// error as add_light_groups
void add_asked_layers(StageRunner& stages, const LayerChoice& layers, Session& session, Image& image);

/// Writes everything that was asked for; returns the names.
/// error as write_exr
std::vector<std::string> write_outputs(const RenderArguments& arguments, const Session& session,
                                       const Image& image);

}  // namespace opaline
