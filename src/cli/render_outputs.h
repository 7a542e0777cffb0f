// SPDX-License-Identifier: GPL-3.0-or-later
// Output files of a rendering.
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

/// error Error{bad_input}: an output is an input file of the scene
void check_outputs_are_no_inputs(const RenderArguments& arguments, const Scene& scene);

/// EXR or PNG, by the extension.
/// error as write_exr
WriteReport write_picture(const std::string& path, const Image& image, const Film& film,
                          const LayerChoice& layers);

/// error Error{bad_input}: a layer missing in this scene's image
void check_layers(const LayerChoice& layers, const Scene& scene);

/// Bytes of the layers made on request only.
std::size_t asked_layer_bytes(const LayerChoice& layers, const Scene& scene);
/// Adds them, one stage each.
/// error as add_light_groups
void add_asked_layers(StageRunner& stages, const LayerChoice& layers, Session& session, Image& image);

/// Writes all outputs; returns their names.
/// error as write_exr
std::vector<std::string> write_outputs(const RenderArguments& arguments, const Session& session,
                                       const Image& image);

}  // namespace opaline
