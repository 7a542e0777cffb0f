// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session/measured_error.h"

#include <algorithm>
#include <cmath>

#include "opaline/image/metrics.h"
#include "opaline/render/direct.h"
#include "session/probe.h"

namespace opaline {
namespace {

constexpr double kPoints = 200, kCountingPixels = 48 * 48, kMostPixels = 256 * 256;
constexpr std::size_t kFirstSamples = 512;

/// As many pixels as it takes to see the points wanted.
Scene sparse_scene(const Session& session, Monitor* monitor) {
  const Image counted = probe_picture(session, probe_scene(session.scene(), kCountingPixels), 0, monitor);
  const std::vector<std::uint8_t> lit = translucent_pixels(counted);
  const double share = double(std::ranges::count(lit, 1)) / double(lit.size());
  return probe_scene(session.scene(), share > 0 ? std::min(kMostPixels, kPoints / share) : 1);
}

/// One channel: with a reference whose noise is independent of the error, squares of both add up.
MeasuredError measured(const std::vector<double>& errors, const std::vector<float>& reference,
                       const std::vector<float>& variance, double floor) {
  MeasuredError result;
  double squares = 0, noise = 0, terms = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (std::isnan(errors[i])) continue;
    const double scale = std::max(double(reference[i]), floor), square = errors[i] * errors[i],
                 own_noise = double(variance[i]) / (scale * scale);
    squares += square;
    noise += own_noise;
    terms += (square - own_noise) * (square - own_noise);
  }
  const ErrorStatistics statistics = error_statistics(errors);
  if (statistics.values < 2 || !(squares > 0)) return result;
  const auto n = double(statistics.values);
  const double mean = (squares - noise) / n,
               of_mean = std::sqrt(std::max(0.0, terms / n - mean * mean) / (n - 1));
  const double root = std::sqrt(std::max(0.0, mean)),
               of_root = mean > of_mean ? of_mean / (2 * root) : std::sqrt(of_mean);
  const double mean_over_root = statistics.mean / std::sqrt(statistics.mean_square);
  result.points = statistics.values;
  result.error = mean_over_root * root;
  result.standard_error = mean_over_root * of_root;
  result.noise = std::sqrt(noise / n);
  return result;
}

MeasuredError worst_channel(const Image& picture, const Image& reference) {
  const Layer diffuse = extract_layer(reference, "diffuse"), variance = extract_layer(reference, "variance");
  const RelativeErrors errors =
      relative_errors(extract_layer(picture, "diffuse"), diffuse, translucent_pixels(picture));
  MeasuredError worst;
  for (std::size_t c = 0; c < errors.channels.size(); ++c) {
    const MeasuredError own =
        measured(errors.channels[c], diffuse.channels[c], variance.channels[c], errors.floors[c]);
    if (own.error >= worst.error) worst = own;
  }
  return worst;
}

}  // namespace

MeasuredError measure_error(const Session& session, double expected, Monitor* monitor) {
  Scene scene = sparse_scene(session, monitor);
  const Image picture = probe_picture(session, scene, 0, monitor);
  scene.settings.method = Method::direct;
  scene.settings.until_error.reset();
  DirectState state;
  const auto measure = [&](std::size_t entry_samples) {
    scene.settings.entry_samples = entry_samples;
    const DirectResult direct =
        render_direct({scene, session.world(), session.rays(), session.plan(), monitor}, state);
    MeasuredError result = worst_channel(picture, direct.picture.image);
    result.entry_samples = direct.entry_samples;
    return result;
  };
  const MeasuredError first = measure(kFirstSamples);
  const double ratio = first.noise / expected, wanted = double(kFirstSamples) * ratio * ratio;
  if (first.points == 0 || ratio <= 1) return first;
  return measure(std::size_t(std::min(wanted, double(kMostVerifySamples))));
}

}  // namespace opaline
