// SPDX-License-Identifier: GPL-3.0-or-later
// Whether --target-error keeps its promise: predicted and measured errors of scene x profile x target, as a
// table and a CSV. usage: bench_target_error FOLDER [SCENE...]; without scenes those that the
// prediction was not tuned on. The truth has 400k samples of another seed, a tolerance of .05 % and four
// times the shadow rays.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/stopwatch.h"
#include "input/load_scene.h"
#include "quality/measured_error.h"
#include "quality/probe.h"
#include "quality/target_error.h"
#include "scene/scene_properties.h"
#include "target_error_scenes.h"
#include "target_error_table.h"

namespace {

using namespace opaline;

// As large as the pictures that people wait for: choosing costs the same for each.
constexpr std::array<int, 2> kResolution{512, 512};
constexpr double kTargets[] = {.05, .02, .01, .005}, kCheckedTarget = .02;

double seconds_alone(const Scene& scene) {
  Session session;
  const Stopwatch watch;
  session.edit(scene);
  session.render();
  return watch.cost({}).cpu_seconds;
}

Image truth_of(Scene scene) {
  Settings& settings = scene.settings;
  settings.samples = 400000;
  settings.seed = 12345;
  settings.tolerance = 5e-4;
  settings.evaluator = EvaluatorKind::dual_tree;
  settings.light_samples *= 4;
  Session session;
  session.edit(std::move(scene));
  return session.render().image;
}

CalibrationRow calibrate(const NamedScene& named, double target, const Image& truth) {
  CalibrationRow row{named.name, profile_kind(named.scene.media.at(0)), target};
  Session session;
  const Stopwatch watch;
  const TargetError chosen = reach_error(session, named.scene, target);
  row.choosing_seconds = watch.cost({}).cpu_seconds;
  const Image picture = session.render().image;
  row.seconds = watch.cost({}).cpu_seconds;
  row.alone_seconds = seconds_alone(session.scene());
  row.predicted = chosen.predicted;
  row.measured = probe_difference(picture, truth);
  row.samples = chosen.samples;
  if (target == kCheckedTarget && row.profile == ProfileKind::dipole) {
    const MeasuredError checked = measure_error(session, chosen.predicted);
    row.direct = checked.error;
    row.direct_error = checked.standard_error;
  }
  return row;
}

std::vector<NamedScene> scenes_of(int argc, char** argv, const std::string& folder) {
  if (argc < 3) return calibration_scenes(folder);
  std::vector<NamedScene> scenes;
  for (int i = 2; i < argc; ++i) {
    const std::vector<std::string> small{"settings.method=hierarchical", "film.samples_per_pixel=1",
                                         "film.filter=box"};
    scenes.push_back({std::filesystem::path(argv[i]).stem().string(), load_scene(argv[i], small)});
    for (Shape& shape : scenes.back().scene.shapes) shape.reflectance = {};
  }
  return scenes;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_target_error FOLDER [SCENE...]\n");
    return 2;
  }
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::string folder = argv[1];
  std::filesystem::create_directories(folder);
  std::vector<CalibrationRow> rows;
  for (NamedScene& named : scenes_of(argc, argv, folder))
    for (const ProfileKind profile : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
      for (Medium& medium : named.scene.media) medium.profile = profile;
      named.scene.film.resolution = kResolution;
      const Image truth = truth_of(named.scene);
      for (const double target : kTargets) {
        rows.push_back(calibrate(named, target, truth));
        fmt::print("{}\n", as_line(rows.back()));
        std::fflush(stdout);
      }
    }
  fmt::print("{}\n", verdict_of(rows));
  write_file(folder + "/target_error.csv", to_csv(calibration_table(rows)));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_target_error: {}\n", error.what());
  return 3;
}
