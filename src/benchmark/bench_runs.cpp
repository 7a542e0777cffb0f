// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_runs.h"

#include <fmt/format.h>

#include <chrono>
#include <map>

#include "core/units.h"

namespace opaline {
namespace {

/// "hierarchical classic max_solid_angle=0.1" -> "hierarchical-classic-max_solid_angle-0.1"
std::string file_name(std::string text) {
  for (char& c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '.' || c == '_' || c == '-' || c == '+';
    if (!plain) c = '-';
  }
  return text;
}

KeptRun kept_run(const BenchArguments& arguments, const BenchScene& scene, const std::string& name,
                 const std::string& picture, const std::vector<std::string>& overrides) {
  return {name, picture, scene.key, render_arguments(arguments, scene, overrides)};
}

void run_once(const BenchArguments& arguments, const BenchFolder& folder, BenchJob& job, int round,
              Monitor& monitor, bool& is_kept) {
  const KeptRun run = kept_run(arguments, *job.scene, fmt::format("{}-round{}", job.name, round + 1),
                               job.picture, rung_overrides(*job.scene, *job.rung));
  const OwnChild child = run_or_recall(folder, run, monitor, is_kept);
  job.failure = child.failure;
  if (job.failure.empty()) job.runs.push_back(bench_run(child));
}

std::string outcome(const BenchJob& job, bool is_kept) {
  if (!job.failure.empty()) return "failed: " + job.failure;
  return short_time(job.runs.back().job.wall_seconds) + (is_kept ? " (reused)" : "");
}

/// Images of one scene by their overrides.
class PartPictures {
 public:
  PartPictures(const BenchArguments& arguments, const BenchFolder& folder, const BenchScene& scene)
      : arguments_(arguments), folder_(folder), scene_(scene) {}

  /// The EXR within the folder; a failure is in `failure`.
  std::string render(const BudgetPart& part, const std::vector<std::string>& overrides, Monitor& monitor,
                     std::string& failure) {
    const auto known = done_.find(overrides);
    if (known != done_.end()) return known->second;
    const std::string name = fmt::format("{}-part{}", scene_.name, done_.size() + 1);
    const std::string picture = "pictures/" + name + ".exr";
    std::vector<std::string> all{"settings.method=hierarchical"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    bool is_kept = false;
    const OwnChild child =
        run_or_recall(folder_, kept_run(arguments_, scene_, name, picture, all), monitor, is_kept);
    write_line(stderr, fmt::format("bench: parts of the error: {} {}: {}{}", scene_.id, part.name,
                                   child.failure.empty() ? short_time(child.cost.wall_seconds)
                                                         : "failed: " + child.failure,
                                   is_kept ? " (reused)" : ""));
    if (child.failure.empty())
      done_[overrides] = picture;
    else
      failure = child.failure;
    return picture;
  }

 private:
  const BenchArguments& arguments_;
  const BenchFolder& folder_;
  const BenchScene& scene_;
  std::map<std::vector<std::string>, std::string> done_;
};

}  // namespace

std::vector<BenchJob> list_jobs(const std::vector<BenchScene>& scenes) {
  std::vector<BenchJob> jobs;
  for (const BenchScene& scene : scenes)
    for (const Rung& rung : scene.rungs) {
      const std::string name = scene.name + '-' + file_name(name_of(rung));
      jobs.push_back({&scene, &rung, name, "pictures/" + name + ".exr", {}, {}});
    }
  return jobs;
}

std::size_t run_jobs(const BenchArguments& arguments, const BenchFolder& folder, std::vector<BenchJob>& jobs,
                     Monitor& monitor) {
  double round_seconds = 0;
  std::size_t kept = 0;
  for (int round = 0; round < arguments.repeats; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (BenchJob& job : jobs) {
      if (!job.failure.empty()) continue;
      bool is_kept = false;
      run_once(arguments, folder, job, round, monitor, is_kept);
      kept += is_kept;
      write_line(stderr, fmt::format("bench: round {} of {}: {} {}: {}", round + 1, arguments.repeats,
                                     job.scene->id, name_of(*job.rung), outcome(job, is_kept)));
    }
    round_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (const int left = arguments.repeats - round - 1; left > 0)
      write_line(stderr, fmt::format("bench: about {} left", short_time(left * round_seconds / (round + 1))));
  }
  return kept;
}

std::vector<BudgetJob> run_budget(const BenchArguments& arguments, const BenchFolder& folder,
                                  const std::vector<BenchScene>& scenes, Monitor& monitor) {
  std::vector<BudgetJob> jobs;
  for (const BenchScene& scene : scenes) {
    if (scene.reference.cells > 0) continue;  // the same scene has its parts already
    PartPictures pictures(arguments, folder, scene);
    for (const BudgetPart& part : error_budget(scene.planned_samples, scene.scene.settings)) {
      BudgetJob job{&scene, part, {}, {}, {}};
      job.here = pictures.render(part, part.here, monitor, job.failure);
      if (job.failure.empty()) job.converged = pictures.render(part, part.converged, monitor, job.failure);
      jobs.push_back(std::move(job));
    }
  }
  return jobs;
}

}  // namespace opaline
