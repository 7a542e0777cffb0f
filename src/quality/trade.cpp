// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/quality/trade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "quality/picture_cost.h"
#include "quality/probe.h"
#include "quality/settings_search.h"

namespace opaline {
namespace {

constexpr std::array kFactors{1 / 16.0, 1 / 8.0, 1 / 4.0, 1 / 2.0, 1.0, 2.0, 4.0};  // of the scene's samples
constexpr double kFewest = 300;                                                     // of a picture
constexpr double kUsualSlope = .8;  // power of the number of samples with which the error falls
constexpr double kProbePixels = 128 * 128;

/// Few digits, so that what is set can be read.
double rounded(double value, double digits) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - digits + 1);
  return std::round(value / unit) * unit;
}

struct Trade {
  Session& session;
  Scene scene;
  Monitor* monitor;
  std::uint64_t pictures = 0;
  Image probe;  ///< of the last point

  double prepared_seconds() const {
    double seconds = 0;
    for (const StageCost& cost : session.costs())
      if (cost.stage != "rays") seconds += cost.cpu_seconds;
    return seconds;
  }

  std::size_t planned_samples() const {
    std::size_t samples = 0;
    for (const GroupPlan& group : session.plan().groups) samples += group.samples;
    return samples;
  }

  void measure(TradePoint& point);
  TradePoint lambert();
};

void Trade::measure(TradePoint& point) {
  Scene tried = scene;
  if (!point.is_given) set_point(tried.settings, point);
  session.edit(tried);
  session.prepare(monitor);
  RenderResult result = probe_picture(session, probe_scene(tried, kProbePixels), ++pictures, monitor);
  point.all_samples = planned_samples();
  point.error = estimated_relative_error(result.image, result.translucent);
  point.seconds = prepared_seconds() + ShadingCost(tried, result.image).of(session, tried);
  probe = std::move(result.image);
}

TradePoint Trade::lambert() {
  scene.settings.method = Method::lambert;
  session.edit(scene);
  session.prepare(monitor);
  const Image picture = probe_picture(session, probe_scene(scene, kProbePixels), ++pictures, monitor).image;
  TradePoint point;
  point.method = Method::lambert;
  point.error = probe_difference(picture, probe);
  point.seconds = ShadingCost(scene, picture).of(session, scene);
  return point;
}

}  // namespace

void set_point(Settings& settings, const TradePoint& point) {
  settings.method = point.method;
  if (point.method == Method::lambert) return;
  settings.sample_spacing = point.sample_spacing;
  settings.samples = point.samples;
  settings.tolerance = point.tolerance;
}

void try_trade(Session& session, Scene scene, const std::function<void(const TradePoint&)>& tried,
               Monitor* monitor) {
  scene.settings.method = Method::hierarchical;
  session.match_new_session(true);  // samples of another point are not left in place: each has its whole cost
  session.edit(scene);
  double area = 0;
  std::size_t given = 0, largest = 0;
  for (const GroupPlan& group : session.plan().groups) {
    area += group.area;
    given += group.samples;
    largest = std::max(largest, group.samples);
  }
  if (given == 0) return;
  Trade trade{session, std::move(scene), monitor, 0, {}};
  const Settings& settings = trade.scene.settings;
  double error = 0;  // expected of the next
  for (const double factor : kFactors) {
    const bool is_given = factor == 1;
    if (factor * double(given) < kFewest && !is_given) continue;
    if (factor > 1 && factor * double(largest) > double(settings.max_samples)) break;
    TradePoint point;
    point.is_given = is_given;
    if (settings.samples)
      point.samples = std::size_t(std::llround(factor * double(*settings.samples)));
    else
      point.sample_spacing = rounded(std::sqrt(area / (factor * double(given))), 4);
    point.tolerance = is_given ? settings.tolerance : rounded(tolerance_for(error > 0 ? error : .02), 2);
    trade.measure(point);
    if (point.error <= 0) return;  // nothing translucent is seen
    error = point.error / std::exp2(kUsualSlope);
    tried(point);
  }
  tried(trade.lambert());
}

}  // namespace opaline
