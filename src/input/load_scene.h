// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of scene files, and overrides of their values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "assets/import_asset.h"
#include "opaline/scene.h"

namespace opaline {

/// Overrides, to precede the given ones, placing an asset's default camera around shapes with a fit_size, and
/// its default lights for the camera in use, at its first key; and limiting the samples of an opaque asset, made
/// translucent without a size, to kMostUnsizedSamples.
/// in    path: of the asset
/// error as merged_scene; as parse_scene and make_mesh if a shape has a fit_size
std::vector<std::string> placed_defaults(const ImportedAsset& asset, const std::string& path,
                                         std::span<const std::string> overrides);

/// Text of a scene file.
/// error Error{bad_input}: no such file, a folder, a mesh, more than 64 MiB
std::string read_scene_text(const std::string& path);

/// A scene's text with the overrides applied, as JSON without comments; numbers keep their spelling. In a
/// file of the same folder, it gives the same scene as text and overrides.
/// frame: replaces keyed values by their value at this frame; none: keeps them
/// error as parse_scene, for checks before those of values
std::string merged_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides, std::optional<int> frame = {});

/// The same with minimal edits of the text: unchanged values and all comments keep their spelling
/// (src/input/edited_text.h).
/// error as merged_scene
std::string edited_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides);

}  // namespace opaline
