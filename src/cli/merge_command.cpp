// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "cli/commands.h"
#include "cli/part_file.h"
#include "opaline/error.h"

namespace opaline {
namespace {

struct NamedRecord {
  std::string path;
  PartRecord record;
};

/// Records of all files, by number.
/// error as merge_command
std::map<std::size_t, NamedRecord> read_records(const std::vector<std::string>& paths) {
  std::map<std::size_t, NamedRecord> parts;
  for (const std::string& path : paths) {
    const PartFile file(path);
    const PartRecord& record = file.record();
    if (record.version != OPALINE_VERSION)
      throw bad_file(path, "is by another version of the program", OPALINE_VERSION, record.version);
    if (!parts.empty()) {
      const NamedRecord& first = parts.begin()->second;
      if (const std::string text = difference(record, first.record); !text.empty())
        throw bad_file(path, text, "a part of the same image as " + first.path);
    }
    if (!file.is_complete())
      throw bad_file(path, "is incomplete", "the same file after repeating its command");
    const auto [other, is_new] = parts.try_emplace(record.part.number, NamedRecord{path, record});
    if (!is_new)
      throw bad_file(path, fmt::format("is part {} of {}", record.part.number, record.part.count),
                     "each part once", other->second.path);
  }
  return parts;
}

/// error Error{bad_input} naming the missing parts
void check_all_are_there(const std::map<std::size_t, NamedRecord>& parts) {
  const std::size_t count = parts.begin()->second.record.part.count;
  std::vector<std::size_t> missing;
  for (std::size_t number = 1; number <= count; ++number)
    if (!parts.contains(number)) missing.push_back(number);
  if (missing.empty()) return;
  throw Error(ErrorKind::bad_input, {}, 0, 0,
              fmt::format("{} of {} parts are missing", missing.size(), count),
              fmt::format("--part {}/{}", fmt::join(missing, fmt::format("/{}, ", count)), count));
}

}  // namespace

void merge_command(const MergeArguments& arguments) {
  const std::map<std::size_t, NamedRecord> parts = read_records(arguments.parts);
  check_all_are_there(parts);
  const PartRecord& record = parts.begin()->second.record;
  RenderArguments render = arguments.render;
  render.scene = record.scene;
  render.overrides = record.overrides;
  render.layers = record.layers;
  if (record.frame) render.frames = {*record.frame};
  render.merged.hash = record.hash;
  for (const auto& [number, part] : parts) render.merged.files.push_back(part.path);
  render_command(render);
}

}  // namespace opaline
