// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_folder.h"

#include <stdlib.h>

#include <filesystem>
#include <optional>

#include "benchmark/machine.h"
#include "benchmark/page.h"
#include "core/atomic_file.h"
#include "core/input_file.h"
#include "opaline/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

void make_folder(const std::string& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) throw run_failed(path, "cannot create the folder: " + failure.message());
}

Json key_of(const KeptRun& run) {
  return {{"program", program_hash()}, {"scene", run.scene_key}, {"arguments", run.arguments}};
}

std::string text_of(const std::string& path) {
  return fs::is_regular_file(path) ? InputFile(path).read_all() : "";
}

/// Empty if the record is missing, damaged or of another run.
std::optional<OwnChild> recall(const BenchFolder& folder, const KeptRun& run) {
  const Json record =
      Json::parse(text_of(folder.file("runs/" + run.name + ".json")), nullptr, /*allow_exceptions=*/false);
  if (!record.is_object() || record.value("run", Json()) != key_of(run)) return std::nullopt;
  if (!fs::exists(folder.file(run.picture))) return std::nullopt;
  try {
    OwnChild child;
    child.events.push_back(record.at("done"));
    const Json& cost = record.at("cost");
    child.cost = {cost.at("user_seconds").get<double>(), cost.at("system_seconds").get<double>(),
                  cost.at("wall_seconds").get<double>(), cost.at("peak_bytes").get<double>()};
    return child;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void record(const BenchFolder& folder, const KeptRun& run, const OwnChild& child) {
  const Json* done = child.event("done");
  if (done == nullptr) throw run_failed("", "a child process returned no result");
  const Json record{{"run", key_of(run)},
                    {"cost",
                     {{"user_seconds", child.cost.user_seconds},
                      {"system_seconds", child.cost.system_seconds},
                      {"wall_seconds", child.cost.wall_seconds},
                      {"peak_bytes", child.cost.peak_bytes}}},
                    {"done", *done}};
  write_file(folder.file("runs/" + run.name + ".json"), compact(record) + '\n');
}

}  // namespace

BenchFolder::BenchFolder(const std::string& report) : path_(report), temporary_(report.empty()) {
  if (temporary_) {
    path_ = (fs::temp_directory_path() / "opaline-bench-XXXXXX").string();
    if (::mkdtemp(path_.data()) == nullptr) throw run_failed(path_, "cannot create a temporary folder");
  }
  make_folder(file("pictures"));
  make_folder(file("runs"));
  check_page_file(file("index.html"));  // reports an unwritable file before the work
  AtomicFile(file("runs/check"));
  AtomicFile(file("pictures/check"));
}

BenchFolder::~BenchFolder() {
  std::error_code ignored;
  if (temporary_) fs::remove_all(path_, ignored);
}

OwnChild run_or_recall(const BenchFolder& folder, const KeptRun& run, Monitor& monitor, bool& is_kept) {
  const std::optional<OwnChild> before = recall(folder, run);
  is_kept = before.has_value();
  if (before) return *before;
  std::vector<std::string> arguments = run.arguments;
  arguments.insert(arguments.end(), {"-o", folder.file(run.picture)});
  OwnChild child = run_own_child(arguments, monitor);
  if (child.failure.empty()) record(folder, run, child);
  return child;
}

}  // namespace opaline
