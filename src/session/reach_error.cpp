// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session/reach_error.h"

#include <algorithm>
#include <cmath>

#include "opaline/image/metrics.h"

namespace opaline {
namespace {

constexpr double kFirstSamples = 2500;
constexpr int kProbeSide = 64;
// A picture's mean error over its difference from the one with half the samples: .47 to .95, mostly .6 to .8, over
// bunny-marble, bunny-skin1, backlit-slab and sphere, both profiles, 5k to 80k samples (against 640k).
constexpr double kErrorPerDifference = 0.7;
// Predictions are up to this much too low.
constexpr double kSafety = 1.25;
// p99 of the evaluator's error is its tolerance, and the mean about a tenth of that.
constexpr double kTolerancePerTarget = 0.5, kMeanPerTolerance = 0.1, kLeastTolerance = 5e-4, kMostTolerance = 0.02;

// The same view with few pixels, each one point: what differs between two of them is the exitance.
Scene probe_of(Scene scene) {
  Film& film = scene.film;
  const double scale = double(kProbeSide) / std::max(film.resolution[0], film.resolution[1]);
  if (scale < 1)
    for (int& side : film.resolution) side = std::max(1, int(std::lround(side * scale)));
  film.samples_per_pixel = 1;
  film.filter = PixelFilter::box;
  film.crop.reset();
  if (scene.settings.evaluator == EvaluatorKind::automatic) scene.settings.evaluator = EvaluatorKind::dual_tree;
  return scene;
}

double difference(const Image& a, const Image& b) {
  double worst = 0;
  const RelativeErrors errors =
      relative_errors(extract_layer(a, "diffuse"), extract_layer(b, "diffuse"), object_pixels(b));
  for (const std::vector<double>& channel : errors.channels)
    if (!channel.empty()) worst = std::max(worst, error_statistics(channel).mean);
  return worst;
}

}  // namespace

ReachedError reach_error(Session& session, Scene scene, double target, Monitor* monitor) {
  Settings& settings = scene.settings;
  settings.samples.reset();
  settings.sample_spacing.reset();
  settings.tolerance = std::clamp(kTolerancePerTarget * target, kLeastTolerance, kMostTolerance);
  session.edit(scene);
  ReachedError result;
  double area = 0;
  for (const GroupPlan& group : session.plan().groups) area += group.area;
  if (!(area > 0)) return result;
  Image before;
  for (double samples = kFirstSamples;; samples *= 2) {
    settings.sample_spacing = std::sqrt(area / samples);
    session.edit(probe_of(scene));
    const Image now = session.render(monitor).image;
    std::size_t placed = 0;
    for (const TranslucentGroup& group : session.groups()) placed += group.surface.samples.size();
    if (before.width > 0) {
      result.error = kErrorPerDifference * difference(before, now) + kMeanPerTolerance * settings.tolerance;
      result.trials.push_back({placed, result.error});
      if (kSafety * result.error <= target) break;
      const bool full = std::ranges::any_of(session.plan().groups, [&](const GroupPlan& group) {
        return 2 * group.samples > settings.max_samples;
      });
      if (full) {
        result.reached = false;
        break;
      }
    }
    before = now;
  }
  session.edit(std::move(scene));
  return result;
}

}  // namespace opaline
