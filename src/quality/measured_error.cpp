// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/measured_error.h"

#include <algorithm>
#include <cmath>

#include "methods/direct/direct.h"
#include "opaline/compare.h"
#include "quality/probe.h"

namespace opaline {
namespace {

constexpr double kPoints = 200, kCountingPixels = 48 * 48, kMostPixels = 256 * 256;
constexpr std::size_t kFirstSamples = 512;
// Bias from noise alone: the mean of sqrt(max(0, x^2 - 1)) for a standard normal x.
constexpr double kLeft = 0.34;
// Noise of the reference, over the expected error.
constexpr double kNoise = 0.7;

/// Number of pixels for the wanted number of visible points.
Scene sparse_scene(const Session& session, Monitor* monitor) {
  const Image counted = probe_picture(session, probe_scene(session.scene(), kCountingPixels), 0, monitor,
                                      session.bounced_places())
                            .image;
  const std::vector<std::uint8_t> lit = translucent_pixels(counted);
  const double share = double(std::ranges::count(lit, 1)) / double(lit.size());
  return probe_scene(session.scene(), share > 0 ? std::min(kMostPixels, kPoints / share) : 1);
}

/// Error of one channel, with the reference's independent noise subtracted at each point. Relative to the
/// image, which has little noise; dividing by the reference would overweight its low values.
MeasuredError measured(const std::vector<double>& errors, const std::vector<float>& picture,
                       const DirectState& reference, std::size_t channel, double floor) {
  std::vector<double> without;
  double noise = 0, mean_noise = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (std::isnan(errors[i])) continue;
    const double scale = std::max(double(picture[i]), floor),
                 own_noise = direct_estimate(reference, i).variance[channel] / (scale * scale);
    without.push_back(std::sqrt(std::max(0.0, errors[i] * errors[i] - own_noise)));
    noise += own_noise;
    mean_noise += std::sqrt(own_noise);
  }
  const ErrorStatistics statistics = error_statistics(without);
  if (statistics.values < 2) return {};
  const auto n = double(statistics.values);
  const double spread = std::max(0.0, statistics.mean_square - statistics.mean * statistics.mean);
  return {statistics.mean, std::hypot(std::sqrt(spread / (n - 1)), kLeft * mean_noise / n),
          std::sqrt(noise / n), statistics.values, 0};
}

/// The channel of the largest error beyond noise.
MeasuredError worst_channel(const Image& picture, const Image& reference, const DirectState& state) {
  const Layer diffuse = extract_layer(picture, "diffuse");
  const RelativeErrors errors =
      relative_errors(extract_layer(reference, "diffuse"), diffuse, translucent_pixels(picture));
  MeasuredError worst;
  for (std::size_t c = 0; c < errors.channels.size(); ++c) {
    const MeasuredError own = measured(errors.channels[c], diffuse.channels[c], state, c, errors.floors[c]);
    if (worst.points == 0 || own.error - own.standard_error > worst.error - worst.standard_error) worst = own;
  }
  return worst;
}

}  // namespace

MeasuredError measure_error(const Session& session, double expected, Monitor* monitor) {
  Scene scene = sparse_scene(session, monitor);
  const Image picture = probe_picture(session, scene, 0, monitor, session.bounced_places()).image;
  scene.settings.method = Method::direct;
  scene.settings.until_error.reset();
  DirectState state;
  const auto measure = [&](std::size_t entry_samples) {
    scene.settings.entry_samples = entry_samples;
    const DirectResult direct =
        render_direct({scene, session.world(), session.rays(), session.plan(), monitor}, state);
    MeasuredError result = worst_channel(picture, direct.picture.image, state);
    result.entry_samples = direct.entry_samples;
    return result;
  };
  const MeasuredError first = measure(kFirstSamples);
  const double ratio = first.noise / (kNoise * expected), wanted = double(kFirstSamples) * ratio * ratio;
  if (first.points == 0 || ratio <= 1) return first;
  return measure(std::size_t(std::min(wanted, double(kMostVerifySamples))));
}

}  // namespace opaline
