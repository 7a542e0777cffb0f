// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session/target_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "opaline/irradiance/light_sampling.h"
#include "session/probe.h"

namespace opaline {
namespace {

// Errors may be in a few pixels alone, beside the edge of a shadow.
constexpr double kProbePixels = 96 * 96, kMostProbePixels = 256 * 256, kEnoughPoints = 3000;
// Nearly all predictions are less than this factor too low.
constexpr double kSafety = 1.3;
// So far beyond the samples at hand an error is extrapolated.
constexpr double kFarthest = 1.5;
// p99 of the evaluator's error is its tolerance, and the mean about a tenth of that.
constexpr double kTolerancePerTarget = 0.5, kLeastTolerance = 5e-4, kMostTolerance = 0.02;
// Shadow rays double where their noise alone is more than this share of the target.
constexpr double kMostNoise = 0.5;
constexpr int kMostLightSamples = 65536;

struct Search {
  Session& session;
  Scene scene;
  Monitor* monitor;
  double area = 0, most_samples = 0;  // of all groups
  double probe_pixels = kProbePixels;
  std::uint64_t pictures = 0;

  void place(double samples) {
    scene.settings.sample_spacing = std::sqrt(area / samples);
    session.edit(scene);
    session.prepare(monitor);
  }
  Image picture() { return probe_picture(session, probe_scene(scene, probe_pixels), ++pictures, monitor); }
  Image picture_of(double samples) {
    place(samples);
    return picture();
  }
};

struct Step {
  double samples = 0, error = 0, slope = 0;

  double error_of(double others) const { return error * std::pow(samples / others, slope); }
  double samples_of(double wanted) const { return samples * std::pow(error / wanted, 1 / slope); }
};

std::size_t points_of(const Image& picture) {
  const std::vector<std::uint8_t> lit = translucent_pixels(picture);
  return std::size_t(std::ranges::count(lit, 1));
}

/// The first picture, of as many pixels as it takes to see enough.
Image first_picture(Search& search, double samples) {
  search.place(samples);
  for (;; search.probe_pixels *= 2) {
    Image picture = search.picture();
    if (double(points_of(picture)) >= kEnoughPoints || search.probe_pixels >= kMostProbePixels)
      return picture;
  }
}

/// Where the noise of shadow rays alone is much of the target.
void double_light_samples(Search& search, const Image& picture, double target) {
  if (std::ranges::all_of(search.scene.lights, is_delta)) return;
  const double noise = probe_difference(search.picture(), picture) / std::sqrt(2);
  int& rays = search.scene.settings.light_samples;
  if (noise > kMostNoise * target) rays = std::min(2 * rays, kMostLightSamples);
}

/// Doubles the samples until about as many are enough, or more are too many.
Step approach(Search& search, Image before, double samples, double target) {
  const auto double_samples = [&] {
    samples = std::min(2 * samples, search.most_samples);
    return search.picture_of(samples);
  };
  Step step;
  Image now = double_samples();
  for (double last = probe_difference(before, now);;) {
    Image next = double_samples();
    const double difference = probe_difference(now, next), error = probe_error(next, now, before);
    const Step previous = std::exchange(step, {samples, error, error_slope(last, difference)});
    // Two estimates in a row are less by chance than one.
    if (previous.error > 0) step.error = std::sqrt(error * previous.error_of(samples));
    last = difference;
    if (step.samples_of(target / kSafety) <= kFarthest * samples || samples >= search.most_samples)
      return step;
    double_light_samples(search, next, target);
    before = std::move(now);
    now = std::move(next);
  }
}

/// Keeps a surface cache if its interpolation is within the target too; returns the error then.
double choose_evaluator(Search& search, double predicted, double target) {
  const Image exact = search.picture();
  search.scene.settings.evaluator = EvaluatorKind::automatic;
  search.session.edit(search.scene);
  search.session.prepare(search.monitor);
  const auto has_cache = [](const TranslucentGroup& group) { return group.surface_cache.has_value(); };
  if (std::ranges::none_of(search.session.groups(), has_cache)) return predicted;
  const double both = std::hypot(predicted, probe_difference(search.picture(), exact));
  if (kSafety * both <= target) return both;
  search.scene.settings.evaluator = EvaluatorKind::dual_tree;
  return predicted;
}

/// As few samples as the step promises the target for.
double samples_for(const Search& search, const Step& step, double fewest, double target) {
  const double samples = std::clamp(step.samples_of(target / kSafety), fewest,
                                    std::min(kFarthest * step.samples, search.most_samples));
  // Those that are placed already cost less than a few less.
  return samples > 0.8 * step.samples ? std::max(samples, step.samples) : samples;
}

/// Settings that the search itself needs; the area and the most samples of all groups.
void begin(Search& search, double target) {
  Settings& settings = search.scene.settings;
  settings.samples.reset();
  settings.tolerance = std::clamp(kTolerancePerTarget * target, kLeastTolerance, kMostTolerance);
  if (settings.evaluator == EvaluatorKind::automatic) settings.evaluator = EvaluatorKind::dual_tree;
  search.session.edit(search.scene);
  double largest = 0;
  for (const GroupPlan& group : search.session.plan().groups) {
    search.area += group.area;
    largest = std::max(largest, group.area);
  }
  // Rounded up, the largest group has as many as it may.
  if (largest > 0) search.most_samples = (double(settings.max_samples) - 1e-6) * search.area / largest;
}

}  // namespace

TargetError reach_error(Session& session, Scene scene, double target, Monitor* monitor) {
  Search search{session, scene, monitor};
  begin(search, target);
  const double fewest = std::min(kFewestTargetSamples, search.most_samples), start = fewest / 2;
  Image first;
  if (fewest > 0) first = first_picture(search, start);
  TargetError result;
  result.sees_translucent = fewest > 0 && points_of(first) > 0;
  if (!result.sees_translucent) {
    session.edit(std::move(scene));
    return result;
  }
  const Step step = approach(search, std::move(first), start, target);
  const double samples = samples_for(search, step, fewest, target);
  result.predicted = step.error_of(samples);
  result.reached = result.predicted <= target;
  search.place(samples);
  if (scene.settings.evaluator == EvaluatorKind::automatic)
    result.predicted = choose_evaluator(search, result.predicted, target);
  for (const GroupPlan& group : session.plan().groups) result.samples += group.samples;
  session.edit(std::move(search.scene));
  return result;
}

}  // namespace opaline
