// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <span>

#include "cli/bench_report.h"
#include "cli/bench_scene.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/machine.h"
#include "cli/own_child.h"
#include "cli/units.h"
#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"
#include "opaline/report/csv.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// Of the pictures that are thrown away at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "opaline-bench-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw run_failed(path_, "cannot make a temporary folder");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(std::size_t number) const { return fmt::format("{}/{}.exr", path_, number); }

 private:
  std::string path_;
};

/// A rung on its way to a row.
struct Job {
  const BenchScene* scene;
  const Rung* rung;
  std::string picture;
  std::vector<BenchRun> runs;
  std::string failure;
};

std::string reference_folder(const BenchArguments& arguments) {
  const fs::path beside = fs::path(arguments.csv).parent_path() / "references";
  const std::string folder = arguments.reference_dir.empty() ? beside.string() : arguments.reference_dir;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw run_failed(folder, "cannot make the folder of references: " + failure.message());
  return folder;
}

std::vector<BenchScene> open_scenes(const BenchArguments& arguments, Monitor& monitor) {
  std::set<std::string> seen;
  for (const std::string& file : arguments.scenes)
    if (!seen.insert(file).second) throw bad_file(file, "the scene is given twice");
  std::vector<BenchScene> scenes;
  for (const std::string& file : arguments.scenes)
    scenes.push_back(open_bench_scene(arguments, file, monitor));
  const std::string folder = arguments.halves.empty() ? reference_folder(arguments) : std::string();
  for (BenchScene& scene : scenes) prepare_reference(arguments, folder, scene, monitor);
  return scenes;
}

std::vector<Job> list_jobs(const std::vector<BenchScene>& scenes, const TemporaryFolder& folder) {
  std::vector<Job> jobs;
  for (const BenchScene& scene : scenes)
    for (const Rung& rung : scene.rungs) jobs.push_back({&scene, &rung, folder.file(jobs.size()), {}, {}});
  return jobs;
}

void run_once(const BenchArguments& arguments, Job& job, Monitor& monitor) {
  const OwnChild child =
      run_own_child(render_arguments(arguments, *job.scene, *job.rung, job.picture), monitor);
  job.failure = child.failure;
  if (job.failure.empty()) job.runs.push_back(bench_run(child));
}

/// Round by round, so that a machine that warms up or is busy for a while is so for all rungs.
void run_all(const BenchArguments& arguments, std::vector<Job>& jobs, Monitor& monitor) {
  double round_seconds = 0;
  for (int round = 0; round < arguments.repeats; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (Job& job : jobs) {
      if (!job.failure.empty()) continue;
      run_once(arguments, job, monitor);
      std::string line = fmt::format("bench: round {} of {}: {} {}: ", round + 1, arguments.repeats,
                                     job.scene->file, name_of(*job.rung));
      line += job.failure.empty() ? short_time(job.runs.back().job.wall_seconds) : "failed: " + job.failure;
      write_line(stderr, line);
    }
    round_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (const int left = arguments.repeats - round - 1; left > 0)
      write_line(stderr, fmt::format("bench: about {} left", short_time(left * round_seconds / (round + 1))));
  }
}

/// Only after the last run: large pictures in this process would count as its children's memory.
void add_errors(const std::vector<Job>& jobs, std::vector<BenchRow>& rows) {
  const BenchScene* loaded = nullptr;
  std::array<Layer, 2> halves;
  std::vector<std::uint8_t> object;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (jobs[i].scene != loaded) {
      loaded = jobs[i].scene;
      object.clear();
      for (std::size_t h = 0; h < 2; ++h) {
        const Image image = read_image(loaded->reference.halves[h]);
        halves[h] = extract_layer(image, "");
        const std::vector<std::uint8_t> shown = object_pixels(image);
        object.resize(shown.size());
        for (std::size_t p = 0; p < shown.size(); ++p) object[p] |= shown[p];
      }
    }
    if (!jobs[i].failure.empty()) continue;
    const Layer picture = extract_layer(read_image(jobs[i].picture), "");
    rows[i].error = picture_error(picture, halves[0], halves[1], object);
  }
}

std::vector<BenchRow> rows_of(const std::vector<Job>& jobs) {
  std::vector<BenchRow> rows;
  const Job* lambert = nullptr;
  for (const Job& job : jobs) {
    if (lambert == nullptr || lambert->scene != job.scene) lambert = &job;  // a scene's first rung
    // A failed rung's earlier rounds are not told.
    const bool failed = !job.failure.empty();
    rows.push_back(summarize(job.scene->file, *job.rung, failed ? std::span<const BenchRun>() : job.runs,
                             lambert->runs));
    rows.back().failure = job.failure;
  }
  add_errors(jobs, rows);
  return rows;
}

/// The machine is described as it was before the first run.
std::vector<std::pair<std::string, std::string>> all_notes(
    const BenchArguments& arguments, const std::vector<BenchScene>& scenes,
    std::vector<std::pair<std::string, std::string>> notes) {
  notes.emplace_back("command", "opaline" + arguments.command_line);
  notes.emplace_back("threads", std::to_string(arguments.threads));
  notes.emplace_back("repeats", std::to_string(arguments.repeats));
  for (const BenchScene& scene : scenes) {
    const BenchReference& reference = scene.reference;
    notes.emplace_back(
        "scene",
        fmt::format("{}, {} x {} pixels, {} a pixel, seed {}, of direct {}", scene.file,
                    scene.scene.film.resolution[0], scene.scene.film.resolution[1],
                    scene.scene.film.samples_per_pixel, scene.scene.settings.seed, scene.direct_seed));
    notes.emplace_back("reference",
                       fmt::format("{}; seeds {}; {}", reference.made, fmt::join(reference.seeds, ", "),
                                   fmt::join(reference.halves, ", ")));
  }
  for (auto& [key, value] : notes) std::ranges::replace(value, '\n', ' ');
  return notes;
}

}  // namespace

int bench_command(const BenchArguments& arguments) {
  std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves must not cost the CSV
  AtomicFile(arguments.csv);      // what cannot be written at the end is said before the work
  Monitor monitor;
  const InterruptHandler interrupt(monitor);
  const auto machine = machine_notes();
  const TemporaryFolder pictures;
  const std::vector<BenchScene> scenes = open_scenes(arguments, monitor);
  std::vector<Job> jobs = list_jobs(scenes, pictures);
  run_all(arguments, jobs, monitor);

  BenchReport report;
  report.rows = rows_of(jobs);
  report.notes = all_notes(arguments, scenes, machine);
  advance(&monitor, 0);
  write_file(arguments.csv, to_csv(bench_table(report)));
  print_bench(report);
  write_line(stderr, "bench: wrote " + arguments.csv);
  const auto failed = std::ranges::count_if(jobs, [](const Job& job) { return !job.failure.empty(); });
  if (failed > 0)
    write_line(stderr,
               fmt::format("opaline: error: {} of {} rungs failed; their rows say why", failed, jobs.size()));
  if (std::ferror(stdout) != 0) throw run_failed("stdout", "cannot write");
  return failed > 0 ? int(ErrorKind::run_failed) : 0;
}

}  // namespace opaline
