// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include "assets/import_asset.h"
#include "cli/commands.h"
#include "core/atomic_file.h"
#include "input/load_scene.h"
#include "opaline/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// Path for the scene file: relative to its folder, unless on another drive.
std::string path_from(const std::string& scene, const std::string& asset) {
  const fs::path folder = fs::absolute(scene).parent_path();
  std::error_code error;
  const fs::path relative = fs::relative(fs::absolute(asset), folder, error);
  return error || relative.empty() ? fs::absolute(asset).string() : relative.string();
}

}  // namespace

void import_command(const ImportArguments& arguments) {
  const ImportedAsset asset = import_asset(arguments.asset, path_from(arguments.scene, arguments.asset),
                                           arguments.material, arguments.animation);
  if (!arguments.log.quiet)
    for (const std::string& line : asset.translated) write_line(stderr, line);
  for (const std::string& line : asset.warnings) print_warning(arguments.log, line);
  const auto is_warning = [&](const std::string& line) {
    return std::ranges::any_of(asset.warnings, [&](const auto& text) { return text.ends_with(": " + line); });
  };
  for (const std::string& line : asset.not_carried)
    if (!is_warning(line)) write_line(stderr, "not imported: " + line);
  const std::string text = edited_scene(asset.text, arguments.scene, arguments.overrides);
  parse_scene(text, arguments.scene);
  if (!arguments.overwrite && fs::is_regular_file(arguments.scene) &&
      read_scene_text(arguments.scene) != text)
    throw bad_file(arguments.scene, "exists with different content", "another name, or --overwrite");
  write_file(arguments.scene, text);
  if (!arguments.log.quiet) write_line(stdout, arguments.scene + ": " + asset.summary);
}

}  // namespace opaline
