// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/settings_search.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "quality/probe.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

constexpr double kMostProbePixels = 256 * 256;
// The tolerance is the p99 of the evaluator's error, and its mean is about a tenth of that.
constexpr double kTolerancePerError = 0.5, kLeastTolerance = 5e-4, kMostTolerance = 0.02;

}  // namespace

void SettingsSearch::begin(double tolerance) {
  Settings& settings = scene.settings;
  settings.tolerance = tolerance;
  if (settings.method == Method::hierarchical && settings.evaluator == EvaluatorKind::automatic)
    settings.evaluator = EvaluatorKind::dual_tree;
  session.edit(scene);
  double largest = 0;
  for (const BodyPlan& group : session.plan().groups) {
    area += group.area;
    largest = std::max(largest, group.area);
  }
  // Rounded up, the largest body reaches the maximum.
  if (largest > 0) most_samples = (double(settings.max_samples) - 1e-6) * area / largest;
}

void SettingsSearch::place(double samples) {
  scene.settings.samples.reset();
  scene.settings.sample_spacing = std::sqrt(area / samples);
  prepare();
}

void SettingsSearch::prepare() {
  session.edit(scene);
  session.prepare(monitor);
  if (bounces_of(scene) == 0 || bounced != nullptr) return;
  const Stopwatch watch;
  bounced = bounced_places({scene, session.world(), session.rays(), session.bodies(), monitor});
  bounced_seconds = watch.cost({}).cpu_seconds;
}

Image SettingsSearch::picture() {
  RenderResult result =
      probe_picture(session, probe_scene(scene, probe_pixels), ++pictures, monitor, bounced);
  estimated = estimated_relative_error(result.image, result.translucent);
  return std::move(result.image);
}

Image SettingsSearch::picture_of(double samples) {
  place(samples);
  return picture();
}

Image SettingsSearch::first_picture() {
  for (;; probe_pixels *= 2) {
    Image image = picture();
    if (translucent_points(image) >= enough_points || probe_pixels >= kMostProbePixels) return image;
  }
}

std::size_t SettingsSearch::planned_samples() const {
  std::size_t samples = 0;
  for (const BodyPlan& group : session.plan().groups) samples += group.samples;
  return samples;
}

bool SettingsSearch::try_surface_cache() {
  scene.settings.evaluator = EvaluatorKind::automatic;
  session.edit(scene);
  session.prepare(monitor);
  return std::ranges::any_of(session.bodies(),
                             [](const Body& body) { return hierarchical_state(body).uses_surface_cache; });
}

double tolerance_for(double error) {
  return std::clamp(kTolerancePerError * error, kLeastTolerance, kMostTolerance);
}

std::size_t translucent_points(const Image& picture) {
  const std::vector<std::uint8_t> lit = translucent_pixels(picture);
  return std::size_t(std::ranges::count(lit, 1));
}

}  // namespace opaline
