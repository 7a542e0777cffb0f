// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluators against the exact sum over the same samples, at the points of the picture: error and time a
// point, and how many times faster the dual tree is at the same error. usage: bench_evaluate SCENE
// [SAMPLES...] [--profile dipole|normalized_diffusion] [--dual-tree]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string_view>

#include "core/stopwatch.h"
#include "input/load_scene.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "render/render.h"
#include "scene/names.h"
#include "session/session_records.h"

namespace {

using namespace opaline;

// What the camera sees: positions and normals of the Lambert picture, tile by tile as a render would ask for
// them.
std::vector<Query> shading_points(Scene scene, const World& world, const RayScene& rays) {
  scene.settings.method = Method::lambert;
  const Image image = render({scene, world, rays}).image;
  const auto place = [&](const char* name) {
    return std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  const std::size_t a = place("A"), p = place("P.X"), n = place("N.X");
  std::vector<Query> points;
  constexpr int kTile = 16;
  for (int y0 = 0; y0 < image.height; y0 += kTile)
    for (int x0 = 0; x0 < image.width; x0 += kTile)
      for (int y = y0; y < std::min(y0 + kTile, image.height); ++y)
        for (int x = x0; x < std::min(x0 + kTile, image.width); ++x) {
          const float* pixel =
              image.pixels.data() +
              (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * image.channels.size();
          if (pixel[a] == 0) continue;
          const Vec3d position(pixel[p], pixel[p + 1], pixel[p + 2]);
          points.push_back({Vec3f(position - world.origin), {pixel[n], pixel[n + 1], pixel[n + 2]}});
        }
  return points;
}

// The exact exitance at every n-th point.
struct Exact {
  std::size_t stride;
  std::vector<Exitance> exitance;
};

// One evaluator at one setting: errors in %, relative to the exact exitance or to 1e-3 of its largest value
// where that is more; microseconds of CPU a point.
struct Row {
  double mean = 0, signed_mean = 0, p99 = 0, largest = 0, time = 0;
};

void set_errors(Row& row, const std::vector<Exitance>& result, const Exact& exact) {
  float brightest = 0;
  for (const Exitance& e : exact.exitance) brightest = std::max(brightest, max_component(e.exitance));
  std::vector<double> errors;
  for (std::size_t i = 0; i < exact.exitance.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double m = double(exact.exitance[i].exitance[c]), floor = 1e-3 * double(brightest);
      const double error = 100 * (double(result[i * exact.stride].exitance[c]) - m) / std::max(m, floor);
      errors.push_back(std::abs(error));
      row.mean += std::abs(error);
      row.signed_mean += error;
    }
  row.mean /= double(errors.size());
  row.signed_mean /= double(errors.size());
  std::ranges::sort(errors);
  row.p99 = errors[errors.size() * 99 / 100];
  row.largest = errors.back();
}

using Ladder = std::vector<Row>;

/// A setting of an evaluator, and whether it is the classic one's solid angle or the dual tree's tolerance.
struct Rung {
  bool classic;
  double setting;
};

Row run_rung(EvaluateInput& input, const Rung& rung, const Exact& exact) {
  input.evaluator = rung.classic ? EvaluatorKind::classic : EvaluatorKind::dual_tree;
  (rung.classic ? input.max_solid_angle : input.tolerance) = rung.setting;
  Row row;
  std::vector<double> times;
  for (int run = 0; run < 3 && (run == 0 || times[0] < 20); ++run) {  // the slow ones vary little
    const Stopwatch watch;
    const std::vector<Exitance> result = evaluate(input);
    times.push_back(1e6 * watch.cost({}).cpu_seconds / double(input.queries.size()));
    if (run == 0) set_errors(row, result, exact);
  }
  std::ranges::sort(times);
  row.time = times[times.size() / 2];
  const std::string name = rung.classic ? fmt::format("classic, {:g} sr", rung.setting)
                                        : fmt::format("dual tree, {:g} %", 100 * rung.setting);
  fmt::print("{:<24} {:8.3f} {:+8.3f} {:8.3f} {:8.3f} {:12.3f}\n", name, row.mean, row.signed_mean, row.p99,
             row.largest, row.time);
  std::fflush(stdout);
  return row;
}

/// At a mean error between two rungs, on straight lines in the logarithms; nothing beyond the ladder's ends.
std::optional<Row> at_mean(Ladder ladder, double mean) {
  std::ranges::sort(ladder, {}, &Row::mean);
  for (std::size_t i = 0; i + 1 < ladder.size(); ++i) {
    const Row &a = ladder[i], &b = ladder[i + 1];
    if (mean < a.mean || mean > b.mean || a.mean == b.mean) continue;
    const double t = std::log(mean / a.mean) / std::log(b.mean / a.mean);
    const auto between = [&](double x, double y) {
      return std::exp(std::log(x) * (1 - t) + std::log(y) * t);
    };
    return Row{mean, 0, between(a.p99, b.p99), between(a.largest, b.largest), between(a.time, b.time)};
  }
  return {};
}

void print_ratio(const Ladder& classic, const Ladder& dual, double mean) {
  const std::optional<Row> a = at_mean(classic, mean);
  std::optional<Row> b = at_mean(dual, mean);
  if (!a) return;
  // A ladder may never be as bad as the mean asked for: its worst rung stands in.
  const Row worst = *std::ranges::max_element(dual, {}, &Row::mean);
  if (!b && worst.mean < mean) b = worst;
  if (!b) return;
  // And p99 no worse: the fastest rung that is as good in both.
  const Row* both = nullptr;
  for (const Row& row : dual)
    if (row.mean <= mean && row.p99 <= a->p99 && (both == nullptr || row.time < both->time)) both = &row;
  fmt::print(
      "at {:.1f} % mean: classic {:.2f} us, p99 {:.2f} %; dual tree {:.3f} us, p99 {:.2f} %: {:.0f} times "
      "faster",
      mean, a->time, a->p99, b->time, b->p99, a->time / b->time);
  if (both != nullptr)
    fmt::print("; with p99 no worse {:.3f} us: {:.0f} times", both->time, a->time / both->time);
  fmt::print("\n");
}

Scene with_settings(const char* file, std::size_t samples, ProfileKind profile) {
  Scene scene = load_scene(file, std::vector<std::string>{"settings.method=hierarchical"});
  scene.settings.samples = samples;
  for (Medium& medium : scene.media) medium.profile = profile;
  return scene;
}

void run(const char* file, std::size_t samples, ProfileKind profile, bool dual_only) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const Scene scene = with_settings(file, samples, profile);
  Session session;
  session.edit(scene);
  session.prepare();
  const World& world = session.world();
  const RayScene& rays = session.rays();
  const Body& group = session.bodies()[0];
  const std::vector<Query> points = shading_points(scene, world, rays);
  Exact exact{std::max<std::size_t>(1, points.size() / 1500), {}};
  std::vector<Query> some;
  for (std::size_t i = 0; i < points.size(); i += exact.stride) some.push_back(points[i]);
  EvaluateInput input{hierarchical_state(group).octree(), hierarchical_state(group).kernel(), some};
  input.evaluator = EvaluatorKind::brute_force;
  const Stopwatch watch;
  exact.exitance = evaluate(input);
  const double pairs = double(some.size()) * double(group.surface.samples.size());
  fmt::print("{}, {}: {} samples, {} points, one thread, median of 3; brute force {:.2f} ns a kernel\n", file,
             name_of(profile), group.surface.samples.size(), points.size(),
             1e9 * watch.cost({}).cpu_seconds / pairs);
  fmt::print("evaluator                  mean %   signed    p99 %    max %  us a point\n");
  input.queries = points;
  Ladder classic, dual;
  if (!dual_only)
    for (const double solid_angle : {0.3, 0.15, 0.08, 0.03, 0.01})
      classic.push_back(run_rung(input, {true, solid_angle}, exact));
  for (const double tolerance : {2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.005, 0.001})
    dual.push_back(run_rung(input, {false, tolerance}, exact));
  for (const double mean : {1.0, 0.1}) print_ratio(classic, dual, mean);
}

ProfileKind profile_of(std::string_view name) {
  return name == "normalized_diffusion" ? ProfileKind::normalized_diffusion : ProfileKind::dipole;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(
        stderr,
        "usage: bench_evaluate SCENE [SAMPLES...] [--profile dipole|normalized_diffusion] [--dual-tree]\n");
    return 2;
  }
  std::vector<std::size_t> samples;
  ProfileKind profile = ProfileKind::dipole;
  bool dual_only = false;
  for (int i = 2; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--profile" && i + 1 < argc)
      profile = profile_of(argv[++i]);
    else if (argument == "--dual-tree")
      dual_only = true;
    else
      samples.push_back(std::strtoul(argv[i], nullptr, 10));
  }
  if (samples.empty()) samples = {150000};
  for (const std::size_t count : samples) run(argv[1], count, profile, dual_only);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_evaluate: {}\n", error.what());
  return 3;
}
