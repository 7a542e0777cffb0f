// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session/target_error.h"

#include <algorithm>
#include <cmath>

#include "opaline/irradiance/light_sampling.h"
#include "session/probe.h"

namespace opaline {
namespace {

constexpr double kProbePixels = 64 * 64, kMostProbePixels = 256 * 256, kEnoughPoints = 1000;
// Single predictions are off by this factor.
constexpr double kSafety = 1.25;
// Error ~ samples^-slope.
constexpr double kUsualSlope = 0.8, kLeastSlope = 0.4, kMostSlope = 1.2;
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
  Image picture() {
    return probe_picture(session, probe_scene(scene, probe_pixels), ++pictures, monitor);
  }
  Image picture_of(double samples) {
    place(samples);
    return picture();
  }
};

struct Step {
  double samples = 0, error = 0, slope = kUsualSlope;

  double error_of(double others) const { return error * std::pow(samples / others, slope); }
  double samples_for(double wanted) const { return samples * std::pow(error / wanted, 1 / slope); }
};

std::size_t points_of(const Image& picture) {
  const std::vector<std::uint8_t> lit = translucent_pixels(picture);
  return std::size_t(std::ranges::count(lit, 1));
}

/// The first picture, of as many pixels as it takes to see enough.
Image first_picture(Search& search, double samples) {
  search.place(samples);
  for (;; search.probe_pixels *= 4) {
    Image picture = search.picture();
    if (double(points_of(picture)) >= kEnoughPoints || search.probe_pixels >= kMostProbePixels) return picture;
  }
}

/// Where the noise of shadow rays alone is much of the target.
void double_light_samples(Search& search, const Image& picture, double target) {
  if (std::ranges::all_of(search.scene.lights, is_delta)) return;
  const double noise = probe_difference(search.picture(), picture) / std::sqrt(2);
  int& rays = search.scene.settings.light_samples;
  if (noise > kMostNoise * target) rays = std::min(2 * rays, kMostLightSamples);
}

/// Doubles the samples until twice as many are enough or too many.
Step approach(Search& search, Image before, double samples, double target) {
  Step step;
  const auto double_samples = [&] {
    samples = std::min(2 * samples, search.most_samples);
    return search.picture_of(samples);
  };
  Image now = double_samples();
  for (double last = probe_difference(before, now);;) {
    Image next = double_samples();
    step.samples = samples;
    step.error = probe_error(next, now, before);
    // What one pair of pictures says of the slope is half believed.
    const double difference = probe_difference(now, next);
    if (last > 0 && difference > 0)
      step.slope = std::clamp((kUsualSlope + std::log2(last / difference)) / 2, kLeastSlope, kMostSlope);
    last = difference;
    if (step.samples_for(target / kSafety) <= 2 * samples || samples >= search.most_samples) return step;
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

}  // namespace

TargetError reach_error(Session& session, Scene scene, double target, Monitor* monitor) {
  Search search{session, std::move(scene), monitor};
  Settings& settings = search.scene.settings;
  const EvaluatorKind evaluator = settings.evaluator;
  settings.samples.reset();
  settings.tolerance = std::clamp(kTolerancePerTarget * target, kLeastTolerance, kMostTolerance);
  if (evaluator == EvaluatorKind::automatic) settings.evaluator = EvaluatorKind::dual_tree;
  session.edit(search.scene);
  double largest = 0;
  for (const GroupPlan& group : session.plan().groups) {
    search.area += group.area;
    largest = std::max(largest, group.area);
  }
  TargetError result;
  result.sees_translucent = false;
  if (!(largest > 0)) return result;
  // Rounded up, the largest group has as many as it may.
  search.most_samples = (double(settings.max_samples) - 1e-6) * search.area / largest;
  const double fewest = std::min(kFewestTargetSamples, search.most_samples), start = fewest / 2;
  Image first = first_picture(search, start);
  result.sees_translucent = points_of(first) > 0;
  if (result.sees_translucent) {
    const Step step = approach(search, std::move(first), start, target);
    double samples = std::clamp(step.samples_for(target / kSafety), fewest,
                         std::min(2 * step.samples, search.most_samples));
    // Those that are placed already cost less than others.
    if (samples > 0.8 * step.samples && samples < step.samples) samples = step.samples;
    result.predicted = step.error_of(samples);
    result.reached = result.predicted <= target;
    search.place(samples);
    if (evaluator == EvaluatorKind::automatic)
      result.predicted = choose_evaluator(search, result.predicted, target);
  }
  for (const GroupPlan& group : session.plan().groups) result.samples += group.samples;
  if (!result.sees_translucent) settings.evaluator = evaluator;
  session.edit(std::move(search.scene));
  return result;
}

}  // namespace opaline
