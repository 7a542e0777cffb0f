// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>
#include <span>

#include "benchmark/bench_folder.h"
#include "benchmark/bench_page.h"
#include "benchmark/bench_pictures.h"
#include "benchmark/bench_report.h"
#include "benchmark/bench_runs.h"
#include "benchmark/bench_scene.h"
#include "benchmark/csv.h"
#include "benchmark/machine.h"
#include "benchmark/regression.h"
#include "benchmark/results_json.h"
#include "core/atomic_file.h"
#include "core/input_file.h"
#include "core/interrupt.h"
#include "opaline/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr int kWorse = 1;  // exit code of a regression

/// Folder of the reference: in the report, beside the CSV, or temporary.
std::string reference_folder(const BenchArguments& arguments, const BenchFolder& report) {
  std::string folder = arguments.reference_dir;
  if (folder.empty())
    folder = !report.is_report() && !arguments.csv.empty()
                 ? (fs::path(arguments.csv).parent_path() / "references").string()
                 : report.file("references");
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw run_failed(folder, "cannot create the folder of references: " + failure.message());
  return folder;
}

std::vector<BenchScene> open_scenes(const BenchArguments& arguments, const BenchFolder& report,
                                    Monitor& monitor) {
  std::set<std::string> seen, names;
  for (const std::string& file : arguments.scenes)
    if (!seen.insert(file).second) throw bad_file(file, "the same scene is given twice");
  std::vector<BenchScene> scenes;
  for (const std::string& file : arguments.scenes) {
    for (BenchScene& scene : open_bench_scenes(arguments, file, monitor)) {
      const std::string name = scene.name;
      for (int n = 2; !names.insert(scene.name).second; ++n) scene.name = fmt::format("{}-{}", name, n);
      scenes.push_back(std::move(scene));
    }
  }
  const bool makes_references = arguments.halves.empty() || arguments.truth;
  const std::string folder = makes_references ? reference_folder(arguments, report) : std::string();
  for (BenchScene& scene : scenes) prepare_reference(arguments, folder, scene, monitor);
  return scenes;
}

std::vector<BenchRow> rows_of(const std::vector<BenchJob>& jobs) {
  std::vector<BenchRow> rows;
  const BenchJob* lambert = nullptr;
  for (const BenchJob& job : jobs) {
    if (lambert == nullptr || lambert->scene != job.scene) lambert = &job;  // first rung of a scene
    // Earlier rounds of a failed rung are not printed.
    const bool failed = !job.failure.empty();
    rows.push_back(
        summarize(job.scene->id, *job.rung, failed ? std::span<const BenchRun>() : job.runs, lambert->runs));
    rows.back().failure = job.failure;
  }
  return rows;
}

void add_notes(const BenchArguments& arguments, const std::vector<BenchScene>& scenes, std::size_t kept,
               std::vector<std::pair<std::string, std::string>>& notes) {
  notes.emplace_back("command", "opaline" + arguments.command_line);
  notes.emplace_back("threads", std::to_string(arguments.threads));
  notes.emplace_back("repeats", std::to_string(arguments.repeats));
  if (kept > 0) notes.emplace_back("kept", fmt::format("{} reused runs from this folder", kept));
  for (const BenchScene& scene : scenes) {
    const BenchReference& reference = scene.reference;
    notes.emplace_back("scene", fmt::format("{}, {} x {} pixels, {} a pixel, seed {}, of direct {}", scene.id,
                                            scene.scene.film.resolution[0], scene.scene.film.resolution[1],
                                            scene.scene.film.samples_per_pixel, scene.scene.settings.seed,
                                            scene.direct_seed));
    notes.emplace_back("reference",
                       fmt::format("{}; seeds {}; {}", reference.made, fmt::join(reference.seeds, ", "),
                                   fmt::join(reference.halves, ", ")));
  }
  for (auto& [key, value] : notes) std::ranges::replace(value, '\n', ' ');
}

/// Results of an earlier benchmark; read before the work.
std::vector<WatchedRung> read_before(const BenchArguments& arguments) {
  if (arguments.against.empty()) return {};
  return parse_results(InputFile(arguments.against).read_all(), arguments.against);
}

/// Writes the page last, after the files it shows.
void write_report(const BenchArguments& arguments, const BenchFolder& folder, const BenchReport& report) {
  const std::string csv = to_csv(bench_table(report));
  if (!arguments.csv.empty()) {
    write_file(arguments.csv, csv);
    write_line(stderr, "bench: wrote " + arguments.csv);
  }
  if (!folder.is_report()) return;
  write_file(folder.file("results.csv"), csv);
  write_file(folder.file("budget.csv"), to_csv(budget_table(report)));
  write_file(folder.file("results.json"), to_json(report));
  write_file(folder.file("index.html"), to_page(report));
  write_line(stderr, "bench: wrote " + folder.file("index.html"));
}

/// The exit code.
int verdict(const BenchArguments& arguments, const std::vector<WatchedRung>& before,
            const BenchReport& report) {
  int code = 0;
  if (!arguments.against.empty()) {
    const Regression regression = compare_results(before, watched_rungs(report));
    if (regression.compared == 0)
      throw bad_file(arguments.against, "has no setting in common with this benchmark",
                     "the same scenes, settings and resolution");
    print_regression(regression, arguments.against);
    if (std::ranges::any_of(regression.changes, &Change::is_worse)) code = kWorse;
  }
  const auto failed =
      std::ranges::count_if(report.rows, [](const BenchRow& row) { return !row.failure.empty(); }) +
      std::ranges::count_if(report.budget, [](const BudgetRow& row) { return !row.failure.empty(); });
  if (failed > 0) {
    write_line(stderr, fmt::format("opaline: error: {} of {} runs failed; their rows state the reason",
                                   failed, report.rows.size() + report.budget.size()));
    code = int(ErrorKind::run_failed);
  }
  return code;
}

int run_bench(const BenchArguments& arguments) {
  std::signal(SIGPIPE, SIG_IGN);  // a reader leaving must not cost the CSV
  const std::vector<WatchedRung> before = read_before(arguments);
  if (!arguments.csv.empty()) AtomicFile(arguments.csv);  // reports an unwritable file before the work
  const BenchFolder folder(arguments.report);
  Monitor monitor;
  const InterruptHandler interrupt(monitor);
  BenchReport report;
  report.notes = machine_notes();
  const std::vector<BenchScene> scenes = open_scenes(arguments, folder, monitor);
  std::vector<BenchJob> jobs = list_jobs(scenes);
  const std::size_t kept = run_jobs(arguments, folder, jobs, monitor);
  std::vector<BudgetJob> parts;
  if (folder.is_report()) parts = run_budget(arguments, folder, scenes, monitor);

  report.rows = rows_of(jobs);
  add_notes(arguments, scenes, kept, report.notes);
  add_pictures(folder, scenes, jobs, report);
  report.budget = budget_rows(folder, parts);
  advance(&monitor, 0);
  write_report(arguments, folder, report);
  print_bench(report);
  return verdict(arguments, before, report);
}

}  // namespace

int bench_command(const BenchArguments& arguments) {
  try {
    return run_bench(arguments);
  } catch (const Error& stopped) {
    if (stopped.kind != ErrorKind::interrupted) throw;
    const bool keeps_references = !arguments.csv.empty() || !arguments.reference_dir.empty();
    throw Error(ErrorKind::interrupted, {}, 0, 0,
                !arguments.report.empty()
                    ? "interrupted; finished references and runs are stored; repeat the command to continue"
                : keeps_references
                    ? "interrupted; finished references are stored; repeat the command to continue"
                    : "interrupted");
  }
}

}  // namespace opaline
