// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/target_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lights/light.h"
#include "quality/probe.h"
#include "quality/settings_search.h"

namespace opaline {
namespace {

// Factors on estimates, exceeding nearly all underestimates: on an image's own estimate; on one confirmed by
// a second image.
constexpr double kSafety = 1.6, kSecondSafety = 1.35;
// Typical error at this number of samples on any shape, and its order in that number.
constexpr double kUsualSamples = 17000, kUsualError = 0.006, kSlope = 0.8;
// Growth of samples: least factor, factor on the prediction by the order (one step is cheaper than two), and
// largest factor.
constexpr double kLeastGrowth = 2.5, kBeyond = 1.25, kMostGrowth = 4;
// Largest noise of shadow rays over the target; more rays above it.
constexpr double kMostNoise = 0.5;
constexpr int kMostLightSamples = 65536;
constexpr int kMostSteps = 12;

/// Usual number of samples for the target.
double first_guess(const SettingsSearch& search, double fewest, double target) {
  const double guess = kUsualSamples * std::pow(kSafety * kUsualError / target, 1 / kSlope);
  return std::clamp(guess, fewest, search.most_samples);
}

/// Noise of the shadow rays of a small image, from the difference of another one.
double noise_of(SettingsSearch& search, const Image& picture) {
  if (std::ranges::all_of(recentred_lights(search.scene, search.session.world()), is_delta)) return 0;
  return probe_difference(search.picture(), picture) / std::sqrt(2);
}

/// Adds shadow rays if their noise is too large; true if so. The error of low-discrepancy points falls faster
/// than the root of their number.
bool add_light_samples(SettingsSearch& search, double noise, double samples, double target) {
  int& rays = search.scene.settings.light_samples;
  const double excess = kSafety * noise / (kMostNoise * target),
               most = std::min(double(kMostLightSamples), kMostShadowRays / samples);
  if (excess <= 1 || rays >= most) return false;
  rays = int(std::min(std::ceil(rays * std::pow(excess, 1.5)), most));
  return true;
}

/// Adds samples and shadow rays until the image's estimate is within the target. Returns the samples.
double approach(SettingsSearch& search, Image picture, double samples, double target) {
  double safety = kSafety;
  for (int step = 0; step < kMostSteps && safety * search.estimated > target; ++step) {
    const double estimated = search.estimated, noise = std::min(noise_of(search, picture), estimated),
                 excess = safety * std::sqrt(estimated * estimated - noise * noise) / target;
    const bool more_rays = add_light_samples(search, noise, samples, target);
    const double most_samples =
        std::min(search.most_samples, kMostShadowRays / search.scene.settings.light_samples);
    const bool more_samples = samples < most_samples && (excess > 1 || !more_rays);
    if (!more_rays && !more_samples) return samples;
    const double before = samples;
    if (more_samples)
      samples = std::min(most_samples, samples * std::clamp(kBeyond * std::pow(excess, 1 / kSlope),
                                                            kLeastGrowth, kMostGrowth));
    const Image last = std::exchange(picture, search.picture_of(samples));
    // Second estimate: the last image's error is about the difference of the two.
    if (samples == before) continue;
    safety = kSecondSafety;
    search.estimated =
        std::sqrt(search.estimated * probe_difference(last, picture) * std::pow(before / samples, kSlope));
  }
  return samples;
}

/// Keeps a surface cache if the image is then within the target, too.
void choose_evaluator(SettingsSearch& search, double target) {
  const double exact = search.estimated;
  if (!search.try_surface_cache()) return;
  search.picture();
  if (kSafety * search.estimated <= std::max(target, kSafety * exact)) return;
  search.scene.settings.evaluator = EvaluatorKind::dual_tree;
  search.estimated = exact;
}

}  // namespace

TargetError reach_error(Session& session, Scene scene, double target, Monitor* monitor) {
  SettingsSearch search{session, scene, monitor};
  search.probe_pixels = kTargetPixels;
  search.enough_points = kTargetPoints;
  search.begin(tolerance_for(target));
  const double fewest = std::min(kFewestTargetSamples, search.most_samples),
               start = first_guess(search, fewest, target);
  Image first;
  if (fewest > 0) {
    search.place(start);
    first = search.first_picture();
  }
  TargetError result;
  result.sees_translucent = fewest > 0 && translucent_points(first) > 0;
  if (!result.sees_translucent) {
    session.edit(std::move(scene));
    return result;
  }
  const double samples = approach(search, std::move(first), start, target);
  if (scene.settings.evaluator == EvaluatorKind::automatic) choose_evaluator(search, target);
  result.predicted = result.of_settings = search.estimated;
  result.reached = result.predicted <= target;
  result.is_short_of_rays = !result.reached && samples < search.most_samples;
  result.samples = search.planned_samples();
  session.edit(std::move(search.scene));
  return result;
}

}  // namespace opaline
