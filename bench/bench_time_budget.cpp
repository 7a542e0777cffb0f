// SPDX-License-Identifier: GPL-3.0-or-later
// Whether --time-budget keeps its promise: CPU spent over the budget, and predicted and measured errors, of
// scene x budget, as a table and a CSV. usage: bench_time_budget FOLDER [SCENE...]; without scenes those of
// bench_target_error, 256 pixels wide. Spent is what choosing, the picture and an EXR take; a scene is loaded
// before. The truth has 400k samples of another seed and a tolerance of .05 %.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>

#include "benchmark/csv.h"
#include "core/atomic_file.h"
#include "core/stopwatch.h"
#include "input/load_scene.h"
#include "quality/probe.h"
#include "quality/time_budget.h"
#include "target_error_scenes.h"

namespace {

using namespace opaline;

constexpr double kBudgets[] = {.75, 1.5, 3};

struct Row {
  std::string scene;
  double budget = 0, spent = 0, measured = 0;
  TimeBudget chosen;

  bool is_kept() const { return spent <= 1.1 * budget; }
};

Image truth_of(Scene scene) {
  Settings& settings = scene.settings;
  settings.samples = 400000;
  settings.seed = 12345;
  settings.tolerance = 5e-4;
  settings.evaluator = EvaluatorKind::dual_tree;
  Session session;
  session.edit(std::move(scene));
  return session.render().image;
}

Row spend(const NamedScene& named, double budget, const Image& truth, const std::string& file) {
  Row row;
  row.scene = named.name;
  row.budget = budget;
  const auto write = [&](const Image& picture) { write_exr(file, picture, true); };
  Session session;
  session.edit(named.scene);
  const Stopwatch watch;
  row.chosen = fit_budget(session, named.scene, budget, write);
  const Image picture = session.render().image;
  write(picture);
  row.spent = watch.cost({}).cpu_seconds;
  row.measured = probe_difference(picture, truth);
  return row;
}

std::string as_line(const Row& row) {
  const std::string predicted =
      row.chosen.predicted ? fmt::format("{:.2g} %", 100 * *row.chosen.predicted) : std::string("unknown");
  return fmt::format(
      "{}: budget {:.3g} s, spent {:.2f} s, {:.0f} %, planned {:.2f} s, {} samples, predicted {}, "
      "measured {:.2g} %{}{}",
      row.scene, row.budget, row.spent, 100 * row.spent / row.budget, row.chosen.planned, row.chosen.samples,
      predicted, 100 * row.measured, row.chosen.fits ? "" : ", TOO LITTLE", row.is_kept() ? "" : ", ABOVE");
}

CsvTable table_of(const std::vector<Row>& rows) {
  CsvTable table{{},
                 {"scene", "budget", "spent", "planned", "fits", "samples", "predicted", "measured"},
                 {"", "s", "s", "s", "", "", "1", "1"},
                 {}};
  for (const Row& row : rows)
    table.rows.push_back({row.scene, fmt::format("{}", row.budget), fmt::format("{:.4f}", row.spent),
                          fmt::format("{:.4f}", row.chosen.planned), row.chosen.fits ? "yes" : "no",
                          fmt::format("{}", row.chosen.samples),
                          row.chosen.predicted ? fmt::format("{:.4g}", *row.chosen.predicted) : "",
                          fmt::format("{:.4g}", row.measured)});
  return table;
}

std::string verdict_of(const std::vector<Row>& rows) {
  std::vector<double> shares;
  std::size_t kept = 0, near = 0, predicted = 0;
  for (const Row& row : rows) {
    if (!row.chosen.fits) continue;
    shares.push_back(row.spent / row.budget);
    kept += row.is_kept() ? 1 : 0;
    if (!row.chosen.predicted) continue;
    ++predicted;
    near += std::abs(std::log(*row.chosen.predicted / row.measured)) < std::log(2.) ? 1 : 0;
  }
  std::ranges::sort(shares);
  if (shares.empty()) return "no budget was enough";
  return fmt::format(
      "{} of {} budgets kept within 110 % ({:.1f} %); spent {:.0f} % in the median, {:.0f} to {:.0f} % in "
      "all; {} more were too little; {} of {} errors predicted within a factor of two",
      kept, shares.size(), 100 * double(kept) / double(shares.size()), 100 * shares[shares.size() / 2],
      100 * shares.front(), 100 * shares.back(), rows.size() - shares.size(), near, predicted);
}

std::vector<NamedScene> scenes_of(int argc, char** argv, const std::string& folder) {
  std::vector<NamedScene> scenes;
  if (argc < 3) scenes = calibration_scenes(folder);
  for (int i = 2; i < argc; ++i)
    scenes.push_back({std::filesystem::path(argv[i]).stem().string(),
                      load_scene(argv[i], std::vector<std::string>{"settings.method=hierarchical"})});
  for (NamedScene& named : scenes) {
    named.scene.film.resolution = {256, 256};
    named.scene.film.samples_per_pixel = 1;
    named.scene.film.filter = PixelFilter::box;
    for (Shape& shape : named.scene.shapes) shape.reflectance = {};
  }
  return scenes;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_time_budget FOLDER [SCENE...]\n");
    return 2;
  }
  const std::string folder = argv[1];
  std::filesystem::create_directories(folder);
  std::vector<Row> rows;
  for (const NamedScene& named : scenes_of(argc, argv, folder)) {
    const Image truth = truth_of(named.scene);
    for (const double budget : kBudgets) {
      rows.push_back(spend(named, budget, truth, folder + "/picture.exr"));
      fmt::print("{}\n", as_line(rows.back()));
      std::fflush(stdout);
    }
  }
  fmt::print("{}\n", verdict_of(rows));
  write_file(folder + "/time_budget.csv", to_csv(table_of(rows)));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_time_budget: {}\n", error.what());
  return 3;
}
