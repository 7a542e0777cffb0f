// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <chrono>

#include "cache/cache_folder.h"
#include "cli/commands.h"
#include "cli/report.h"
#include "core/units.h"
#include "opaline/error.h"

namespace opaline {
namespace {

/// An entry and its defect, if checked.
struct Checked {
  CacheEntry entry;
  std::string problem;
};

std::string age_of(const CacheEntry& entry) {
  const auto age = std::filesystem::file_time_type::clock::now() - entry.last_used;
  const auto seconds =
      std::max<std::int64_t>(0, std::chrono::duration_cast<std::chrono::seconds>(age).count());
  if (seconds < 120) return fmt::format("{} s", seconds);
  if (seconds < 7200) return fmt::format("{} min", seconds / 60);
  if (seconds < 172800) return fmt::format("{} h", seconds / 3600);
  return fmt::format("{} days", seconds / 86400);
}

Json json_of(const std::vector<Checked>& all) {
  Json list = Json::array();
  for (const auto& [entry, problem] : all) {
    Json line{{"file", entry.file}, {"stage", entry.stage}, {"key", hex(entry.key)}, {"bytes", entry.bytes}};
    if (!problem.empty()) line["problem"] = problem;
    list.push_back(line);
  }
  return list;
}

void print_text(const std::vector<Checked>& all, const char* what) {
  std::uint64_t total = 0;
  for (const auto& [entry, problem] : all) {
    total += entry.bytes;
    write_line(stdout, fmt::format("{:<48} {:>9}  used {:>7} ago{}", entry.file, short_bytes(entry.bytes),
                                   age_of(entry), problem.empty() ? "" : "  " + problem));
  }
  write_line(stdout, fmt::format("{} {} of {}", all.size(), what, short_bytes(total)));
}

std::vector<CacheEntry> prune(const CacheArguments& arguments) {
  bool said = false;
  return prune_cache(arguments.folder, arguments.most_bytes, [&] {
    if (!said) print_warning(arguments.log, "waiting for another process to unlock " + arguments.folder);
    return said = true;
  });
}

}  // namespace

int cache_command(const CacheArguments& arguments) {
  std::vector<Checked> all;
  const bool is_pruning = arguments.action == CacheAction::prune;
  for (CacheEntry& entry : is_pruning ? prune(arguments) : list_cache(arguments.folder))
    all.push_back({std::move(entry), {}});
  bool sound = true;
  if (arguments.action == CacheAction::verify)
    for (auto& [entry, problem] : all) {
      problem = problem_of(arguments.folder, entry);
      sound = sound && problem.empty();
    }
  if (arguments.log.format == LogFormat::json)
    write_line(stdout, compact({{is_pruning ? "removed" : "entries", json_of(all)}, {"sound", sound}}));
  else
    print_text(all, is_pruning ? "entries removed" : "entries");
  return sound ? 0 : 1;
}

}  // namespace opaline
