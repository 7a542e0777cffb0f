// SPDX-License-Identifier: GPL-3.0-or-later
// Whether pictures know their error: the estimate of the closing line (estimated_relative_error) against the
// true mean error, over random pairs of scene and settings: every kind of light and body, both profiles, mean
// free paths of .002 to 5 times the body, 1 to 256 camera rays a pixel, 250 to 100,000 samples. The truth is
// the mean of two pictures of other seeds with eight times the samples (50,000 to 250,000), whose own noise
// is taken out by their difference; pairs whose error that noise hides are counted apart. An estimate is of the
// error that is to be expected: where the mean free path is as long as the body, the error of one picture is a
// single number drawn from a distribution, within .4 and 1.6 of whose deviation only 58 % of draws lie. So the
// error is the mean over pictures of other seeds: at least five, and as many as tell that mean to 12 % (at most
// 40); the share for the one picture is printed beside it. Truths are kept in FOLDER, beside the scene files:
// delete it when pictures of many samples have become others.
// usage: bench_error_estimate FOLDER [--quick] [--pairs FIRST-LAST] [--direct]
//   --quick   every fifth pair;  --direct   measures each twentieth by Method::direct, too
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "benchmark/csv.h"
#include "core/atomic_file.h"
#include "core/random.h"
#include "error_estimate_measure.h"
#include "error_estimate_pairs.h"
#include "input/load_scene.h"
#include "opaline/compare.h"
#include "quality/measured_error.h"

namespace {

using namespace opaline;

constexpr std::size_t kPairs = 200, kQuickStep = 5, kDirectStep = 20;
constexpr std::size_t kFewestDraws = 5, kMostDraws = 40;
constexpr double kUncertainty = .12;
constexpr double kFewestTruth = 50000, kMostTruth = 250000, kTruthRays = 5e6;

struct Row {
  std::size_t index = 0;
  RandomPair pair;
  std::size_t samples = 0;             // of the largest group
  double estimated = 0, expected = 0;  // mean error: as the picture says; of pictures of other seeds
  TrueError truth;                     // of the picture itself
  MeasuredError direct;                // points == 0: not asked for

  double ratio() const { return estimated / expected; }
  bool is_right() const { return within_factor_2(ratio()); }
  bool is_right_for_itself() const { return within_factor_2(estimated / truth.mean); }
  static bool within_factor_2(double ratio) { return ratio >= .5 && ratio <= 2; }
};

struct Options {
  std::string folder;
  std::size_t first = 0, last = kPairs - 1, step = 1;
  bool direct = false;
};

Image truth_of(Scene scene, std::size_t samples, std::uint64_t seed, const std::string& file) {
  if (std::filesystem::exists(file)) return read_image(file);
  Settings& settings = scene.settings;
  const double count = std::clamp(8 * double(samples), kFewestTruth, kMostTruth);
  settings.samples = std::size_t(count);
  settings.max_samples = std::size_t(kMostTruth);
  settings.seed = hash_bits(settings.seed, seed);
  settings.tolerance = 1e-3;
  settings.evaluator = EvaluatorKind::dual_tree;
  settings.light_samples = int(std::clamp(kTruthRays / count, 32.0, 4.0 * settings.light_samples + 32));
  Session session;
  session.edit(std::move(scene));
  const Image image = session.render().image;
  write_exr(file, image, false);
  return image;
}

/// Of the mean of these errors, relative: its standard error.
double uncertainty(const std::vector<double>& errors) {
  const auto [mean, variance] = boost::math::statistics::mean_and_sample_variance(errors);
  return std::sqrt(variance / double(errors.size())) / mean;
}

Row measure(std::size_t index, const Options& options) {
  Row row{index, random_pair(index, OPALINE_SCENES_DIR), 0, 0, 0, {}, {}};
  const std::string name = fmt::format("{}/pair-{:03}", options.folder, index);
  write_file(name + ".json", row.pair.json);
  Scene scene = load_scene(name + ".json", std::vector<std::string>{"settings.method=hierarchical"});
  for (Shape& shape : scene.shapes) shape.reflectance = {};  // errors are those of translucent surfaces
  Session session;
  session.edit(scene);
  for (const BodyPlan& group : session.plan().groups) row.samples = std::max(row.samples, group.samples);
  const RenderResult picture = session.render();
  row.estimated = estimated_relative_error(picture.image, picture.translucent);
  const Image a = truth_of(scene, row.samples, 1, name + "-a.exr"),
              b = truth_of(scene, row.samples, 2, name + "-b.exr");
  row.truth = true_error(picture.image, a, b, picture.translucent);
  std::vector<double> errors{row.truth.mean};
  while (errors.size() < kFewestDraws || (errors.size() < kMostDraws && uncertainty(errors) > kUncertainty)) {
    scene.settings.seed = hash_bits(std::uint64_t(index), 100 + errors.size());
    session.edit(scene);
    errors.push_back(true_error(session.render().image, a, b, picture.translucent).mean);
  }
  row.expected = boost::math::statistics::mean(errors);
  if (options.direct && index % kDirectStep == 0)
    row.direct = measure_error(session, std::max(1e-3, row.truth.mean));
  return row;
}

std::string as_line(const Row& row) {
  const RandomPair& p = row.pair;
  std::string line = fmt::format(
      "{:3} {:9} {:28} path {:8.3g} spp {:3} light {:3} samples {:6}{} {:13} estimated {:8.3g} % true "
      "{:8.3g} % (this picture {:.3g}, noise {:.2g}) ratio {:.3g}",
      row.index, p.body, p.lights, p.length, p.samples_per_pixel, p.light_samples, row.samples,
      p.samples == "default" ? "*" : " ", p.evaluator, 100 * row.estimated, 100 * row.expected,
      100 * row.truth.mean, 100 * row.truth.noise, row.ratio());
  if (row.direct.points > 0)
    line +=
        fmt::format("  direct {:.3g} +- {:.2g} %", 100 * row.direct.error, 100 * row.direct.standard_error);
  return line;
}

std::string band(double value, std::initializer_list<double> limits) {
  double below = 0;
  for (const double limit : limits) {
    if (value < limit) return fmt::format("{:6g} to {:g}", below, limit);
    below = limit;
  }
  return fmt::format("{:6g} and more", below);
}

/// The share within a factor 2, by what the pairs have in common.
void print_shares(const std::vector<Row>& rows) {
  const std::pair<const char*, std::function<std::string(const Row&)>> kinds[] = {
      {"all", [](const Row&) { return std::string(); }},
      {"body", [](const Row& r) { return r.pair.body; }},
      {"lights", [](const Row& r) { return r.pair.lights; }},
      {"evaluator", [](const Row& r) { return r.pair.evaluator; }},
      {"mean free path",
       [](const Row& r) {
         return band(r.pair.length, {.008, .03, .12, .5});
       }},
      {"rays a pixel",
       [](const Row& r) {
         return band(r.pair.samples_per_pixel, {2, 8, 32});
       }},
      {"light samples",
       [](const Row& r) {
         return band(r.pair.light_samples, {2, 8, 32});
       }},
      {"samples",
       [](const Row& r) {
         return band(double(r.samples), {1000, 4000, 16000});
       }},
  };
  const auto lucky = std::ranges::count_if(rows, &Row::is_right_for_itself);
  fmt::print("{:.1f} % within a factor 2 of the error of the very picture\n",
             100. * double(lucky) / double(rows.size()));
  for (const auto& [name, kind] : kinds) {
    struct Count {
      int all = 0, right = 0, low = 0;
    };
    std::map<std::string, Count> counts;
    for (const Row& row : rows) {
      Count& count = counts[kind(row)];
      ++count.all;
      count.right += row.is_right();
      count.low += row.ratio() < .5;
    }
    for (const auto& [value, count] : counts)
      fmt::print("{:15} {:30} {:5.1f} % of {:3} within a factor 2, {} too low, {} too high\n", name, value,
                 100. * count.right / count.all, count.all, count.low, count.all - count.right - count.low);
  }
}

void print_worst(std::vector<Row> rows) {
  const auto off = [](const Row& row) { return -std::abs(std::log(row.ratio())); };
  std::ranges::sort(rows, {}, off);
  fmt::print("\nthe worst:\n");
  for (std::size_t i = 0; i < std::min<std::size_t>(15, rows.size()) && !rows[i].is_right(); ++i)
    fmt::print("{}\n    bench_error_estimate FOLDER --pairs {}-{}\n", as_line(rows[i]), rows[i].index,
               rows[i].index);
}

void write_table(const std::vector<Row>& rows, const std::string& file) {
  CsvTable table;
  table.names = {"pair",           "body",    "lights",    "path",      "rays",
                 "light_samples",  "samples", "evaluator", "estimated", "true",
                 "of the picture", "noise",   "rms"};
  table.units = {"", "", "", "of the body", "a pixel", "", "", "", "", "", "", "", ""};
  for (const Row& row : rows) {
    const RandomPair& p = row.pair;
    table.rows.push_back({std::to_string(row.index), p.body, p.lights, fmt::format("{:.4g}", p.length),
                          std::to_string(p.samples_per_pixel), std::to_string(p.light_samples),
                          std::to_string(row.samples), p.evaluator, fmt::format("{:.4g}", row.estimated),
                          fmt::format("{:.4g}", row.expected), fmt::format("{:.4g}", row.truth.mean),
                          fmt::format("{:.4g}", row.truth.noise), fmt::format("{:.4g}", row.truth.rms)});
  }
  write_file(file, to_csv(table));
}

Options options_of(int argc, char** argv) {
  Options options;
  if (argc < 2)
    throw std::runtime_error("usage: bench_error_estimate FOLDER [--quick] [--pairs A-B] [--direct]");
  options.folder = argv[1];
  for (int i = 2; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--quick") options.step = kQuickStep;
    if (option == "--direct") options.direct = true;
    if (option != "--pairs" || ++i == argc) continue;
    const std::string range = argv[i];
    options.first = std::stoul(range);
    options.last = std::stoul(range.substr(range.find('-') + 1));
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) try {
  const Options options = options_of(argc, argv);
  std::filesystem::create_directories(options.folder);
  std::vector<Row> known;
  std::size_t unseen = 0, hidden = 0;
  for (std::size_t i = options.first; i <= options.last; i += options.step) {
    const Row row = measure(i, options);
    const bool is_seen = row.truth.noisy > 0;
    fmt::print("{}{}\n", as_line(row),
               !is_seen               ? "  dark"
               : row.truth.is_known() ? ""
                                      : "  hidden by the truth's noise");
    std::fflush(stdout);
    if (!is_seen)
      ++unseen;
    else if (!row.truth.is_known())
      ++hidden;
    else
      known.push_back(row);
  }
  fmt::print("\n{} pairs; {} show no light, the truth's noise hides the error of {}\n",
             known.size() + unseen + hidden, unseen, hidden);
  print_shares(known);
  print_worst(known);
  write_table(known, options.folder + "/error_estimate.csv");
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_error_estimate: {}\n", error.what());
  return 3;
}
