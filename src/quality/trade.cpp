// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/trade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"
#include "quality/picture_cost.h"
#include "quality/probe.h"
#include "quality/settings_search.h"

namespace opaline {
namespace {

constexpr std::array kFactors{1 / 16.0, 1 / 8.0, 1 / 4.0, 1 / 2.0,
                              1.0,      2.0,     4.0};  // factors of the scene's samples
constexpr double kFewest = 300;                         // minimum samples of an image
constexpr double kProbePixels = 128 * 128;

/// Rounds to few digits, for readable settings.
double rounded(double value, double digits) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - digits + 1);
  return std::round(value / unit) * unit;
}

struct Trade {
  SettingsSearch search;
  Scene given;
  Image probe;  ///< probe of the last point

  double prepared_seconds() const {
    double seconds = 0;
    for (const StageCost& cost : search.session.costs())
      if (cost.stage != "rays") seconds += cost.cpu_seconds;
    return seconds;
  }

  void measure(TradePoint& point);
  TradePoint lambert();
};

void Trade::measure(TradePoint& point) {
  search.scene = given;
  if (!point.is_given) set_point(search.scene.settings, point);
  search.prepare();
  RenderResult result = probe_picture(search.session, probe_scene(search.scene, kProbePixels),
                                      ++search.pictures, search.monitor, search.bounced);
  point.all_samples = search.planned_samples();
  point.error = estimated_relative_error(result.image, result.translucent);
  point.seconds =
      prepared_seconds() + search.bounced_seconds + ShadingCost(search.scene, result.image).of(search);
  probe = std::move(result.image);
}

TradePoint Trade::lambert() {
  search.scene = given;
  search.scene.settings.method = Method::lambert;
  search.bounced.reset();
  search.bounced_seconds = 0;
  search.prepare();
  const Image picture = probe_picture(search.session, probe_scene(search.scene, kProbePixels),
                                      ++search.pictures, search.monitor, search.bounced)
                            .image;
  TradePoint point;
  point.method = Method::lambert;
  point.error = probe_difference(picture, probe);
  point.seconds = search.bounced_seconds + ShadingCost(search.scene, picture).of(search);
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
  session.match_new_session(true);  // each point has its full cost, without samples of another one
  session.edit(scene);
  double area = 0;
  std::size_t given = 0, largest = 0;
  for (const BodyPlan& group : session.plan().groups) {
    area += group.area;
    given += group.samples;
    largest = std::max(largest, group.samples);
  }
  if (given == 0) return;
  Trade trade{{session, scene, monitor}, scene, {}};
  const Settings& settings = trade.given.settings;
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
    if (point.error <= 0) return;  // no translucent shape is visible
    error = point.error / std::exp2(kUsualSlope);
    tried(point);
  }
  tried(trade.lambert());
}

}  // namespace opaline
