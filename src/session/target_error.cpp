// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session/target_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "opaline/irradiance/light_sampling.h"
#include "session/probe.h"
#include "session/settings_search.h"

namespace opaline {
namespace {

// Nearly all predictions are less than this factor too low.
constexpr double kSafety = 1.4;
// So far beyond the samples at hand an error is extrapolated.
constexpr double kFarthest = 1.5;
// Shadow rays double where their noise alone is more than this share of the target.
constexpr double kMostNoise = 0.5;
constexpr int kMostLightSamples = 65536;

struct Step {
  double samples = 0, error = 0, slope = 0;

  double error_of(double others) const { return error * std::pow(samples / others, slope); }
  double samples_of(double wanted) const { return samples * std::pow(error / wanted, 1 / slope); }
};

/// Where the noise of shadow rays alone is much of the target.
void double_light_samples(SettingsSearch& search, const Image& picture, double target) {
  if (std::ranges::all_of(search.scene.lights, is_delta)) return;
  const double noise = probe_difference(search.picture(), picture) / std::sqrt(2);
  int& rays = search.scene.settings.light_samples;
  if (noise > kMostNoise * target) rays = std::min(2 * rays, kMostLightSamples);
}

/// Doubles the samples until about as many are enough, or more are too many.
Step approach(SettingsSearch& search, Image before, double samples, double target) {
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
double choose_evaluator(SettingsSearch& search, double predicted, double target) {
  const Image exact = search.picture();
  if (!search.try_surface_cache()) return predicted;
  const double both = std::hypot(predicted, probe_difference(search.picture(), exact));
  if (kSafety * both <= target) return both;
  search.scene.settings.evaluator = EvaluatorKind::dual_tree;
  return predicted;
}

/// As few samples as the step promises the target for.
double samples_for(const SettingsSearch& search, const Step& step, double fewest, double target) {
  const double samples = std::clamp(step.samples_of(target / kSafety), fewest,
                                    std::min(kFarthest * step.samples, search.most_samples));
  // Those that are placed already cost less than a few less.
  return samples > 0.8 * step.samples ? std::max(samples, step.samples) : samples;
}

}  // namespace

TargetError reach_error(Session& session, Scene scene, double target, Monitor* monitor) {
  SettingsSearch search{session, scene, monitor};
  search.begin(tolerance_for(target));
  const double fewest = std::min(kFewestTargetSamples, search.most_samples), start = fewest / 2;
  Image first;
  if (fewest > 0) first = search.first_picture(start);
  TargetError result;
  result.sees_translucent = fewest > 0 && translucent_points(first) > 0;
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
  result.samples = search.planned_samples();
  session.edit(std::move(search.scene));
  return result;
}

}  // namespace opaline
