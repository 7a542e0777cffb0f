// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/profile_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "opaline/scene/enumerations.h"
#include "opaline/transport/fresnel.h"
#include "opaline/transport/point_source.h"

namespace opaline {
namespace {

constexpr double kClearest = .5;  // a ring whose relative error is larger says nothing
constexpr double kFirstShare = 3e-3,
                 kLastShare = 2e-4;  // of the total, nearer and farther than what is shown

struct Range {
  double low = 1, high = 2;
};

double middle_of(const WalkedRing& ring) {
  return std::sqrt(.5 * (ring.low * ring.low + ring.high * ring.high));
}

bool is_clear(const WalkedRing& ring) {
  return ring.profile.value > 0 && ring.profile.error < kClearest * ring.profile.value;
}

std::vector<PlotPoint> points_of(const WalkedFace& face) {
  std::vector<PlotPoint> points;
  for (const WalkedRing& ring : face.rings)
    if (is_clear(ring)) points.push_back({middle_of(ring), ring.profile.value, ring.profile.error});
  return points;
}

/// Distances between which nearly all light leaves.
Range distances_of(const WalkedFace& face) {
  const double total = face.total.value;
  Range range{0, 0};
  for (const WalkedRing& ring : face.rings) {
    if (!is_clear(ring)) continue;
    if (range.low == 0 && ring.within.value > kFirstShare * total) range.low = middle_of(ring);
    if (ring.within.value < (1 - kLastShare) * total) range.high = ring.high;
  }
  if (range.low > 0 && range.high > 2 * range.low) return range;
  if (face.rings.empty()) return {};
  return {face.rings.front().high, face.rings.back().high};
}

Range values_of(std::span<const PlotPoint> points, const Range& distances) {
  Range range{0, 0};
  for (const PlotPoint& point : points) {
    if (point.x < distances.low || point.x > distances.high) continue;
    if (range.low == 0) range = {point.y, point.y};
    range = {std::min(range.low, point.y), std::max(range.high, point.y)};
  }
  return range.low > 0 ? Range{range.low / 2, range.high * 4} : Range{};
}

ModelFace model_face(const ProfileReport& report, const ChannelProfile& model, bool is_far) {
  return {&model, is_far ? report.request.thickness : 0};
}

PlotSeries walked_series(bool is_diffuse, std::vector<PlotPoint> points) {
  return {is_diffuse ? "walks, diffuse light" : "walks, along the normal", 0,
          is_diffuse ? PlotStyle::dots : PlotStyle::hollow_dots, std::move(points)};
}

PlotSeries model_series(std::size_t kind) {
  std::string name(kProfileNames[kind]);
  std::ranges::replace(name, '_', ' ');
  return {std::move(name), kind + 1, PlotStyle::curve, {}};
}

double middle_of(const WalkedCosine& bin) {
  return .5 * (bin.low + bin.high);
}

std::vector<PlotPoint> points_of(std::span<const WalkedCosine> bins) {
  std::vector<PlotPoint> points;
  for (const WalkedCosine& bin : bins)
    if (bin.value.value != 0) points.push_back({middle_of(bin), bin.value.value, bin.value.error});
  return points;
}

}  // namespace

Plot profile_plot(const ProfileReport& report, const ProfiledChannel& channel, bool is_far) {
  const WalkedFace& diffuse = is_far ? channel.diffuse.through : channel.diffuse.back;
  const WalkedFace& normal = is_far ? channel.normal.through : channel.normal.back;
  const Range distances = distances_of(diffuse), values = values_of(points_of(diffuse), distances);
  Plot plot{is_far ? "Light that leaves the far face, by distance from where it entered"
                   : "Light that leaves, by distance from where it entered",
            {"distance r, mm", distances.low, distances.high},
            {"share of the entered flux, 1/mm²", values.low, values.high}};
  for (std::size_t kind = 0; kind < channel.models.size(); ++kind) {
    PlotSeries series = model_series(kind);
    const ModelFace model = model_face(report, channel.models[kind], is_far);
    constexpr int kSteps = 120;
    for (int i = 0; i <= kSteps; ++i) {
      const double r = distances.low * std::pow(distances.high / distances.low, double(i) / kSteps);
      series.points.push_back({r, model.profile_at(r)});
    }
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back(walked_series(false, points_of(normal)));
  plot.series.push_back(walked_series(true, points_of(diffuse)));
  return plot;
}

Plot ratio_plot(const ProfileReport& report, const ProfiledChannel& channel) {
  const WalkedFace& walked = channel.diffuse.back;
  const Range distances = distances_of(walked);
  Plot plot{"Each model over the walks in diffuse light: 1 is right",
            {"distance r, mm", distances.low, distances.high},
            {"model / walks", .2, 5},
            1};
  for (std::size_t kind = 0; kind < channel.models.size(); ++kind) {
    PlotSeries series = model_series(kind);
    const ModelFace model = model_face(report, channel.models[kind], false);
    for (const WalkedRing& ring : walked.rings)
      if (is_clear(ring))
        series.points.push_back(
            {middle_of(ring), (model.within(ring.high) - model.within(ring.low)) / ring.share.value});
    plot.series.push_back(std::move(series));
  }
  PlotSeries one = walked_series(true, {});
  for (const PlotPoint& point : points_of(walked)) one.points.push_back({point.x, 1, point.error / point.y});
  plot.series.push_back(std::move(one));
  return plot;
}

/// A linear axis from a round value below all points to one above.
PlotAxis axis_around(const std::string& label, const std::vector<PlotSeries>& series) {
  Range range{INFINITY, -INFINITY};
  for (const PlotSeries& s : series)
    for (const PlotPoint& point : s.points)
      range = {std::min(range.low, point.y - point.error), std::max(range.high, point.y + point.error)};
  if (!(range.low <= range.high)) return {label, 0, 1, true};
  const double margin = std::max(.01, .15 * (range.high - range.low)), step = .02;
  return {label, std::max(0., std::floor((range.low - margin) / step) * step),
          std::ceil((range.high + margin) / step) * step, true};
}

Plot entry_plot(const ProfileReport& report, const ProfiledChannel& channel) {
  Plot plot{"Albedo by angle of entry: share of what entered that comes back",
            {"cosine of the angle of entry, outside", 0, 1, true},
            {}};
  for (std::size_t kind = 0; kind < channel.models.size(); ++kind) {
    PlotSeries series = model_series(kind);
    const double total = model_face(report, channel.models[kind], false).total();
    series.points = {{0, total}, {1, total}};
    plot.series.push_back(std::move(series));
  }
  const WalkedValue& normal = channel.normal.back.total;
  plot.series.push_back(walked_series(false, {{1, normal.value, normal.error}}));
  plot.series.push_back(walked_series(true, points_of(channel.diffuse.albedo_by_entry)));
  plot.y = axis_around("share", plot.series);
  return plot;
}

Plot exit_plot(const ProfileReport&, const ProfiledChannel& channel) {
  Plot plot{
      "Radiance by angle of exit, over a Lambert emitter's; the line is the Fresnel transmittance of all "
      "models",
      {"cosine of the angle of exit, outside", 0, 1, true},
      {"radiance / Lambert's", 0, 1, true},
      1};
  const double eta = channel.medium.eta, entered = 1 - average_reflectance_outside(eta);
  PlotSeries models{"Fresnel transmittance, all models", 1, PlotStyle::curve, {}};
  for (int i = 0; i <= 100; ++i)
    models.points.push_back({i / 100., (eta == 1 ? 1 : fresnel_transmittance(i / 100., eta)) / entered});
  plot.series.push_back(std::move(models));
  plot.series.push_back(walked_series(false, points_of(channel.normal.back.angular_exit)));
  plot.series.push_back(walked_series(true, points_of(channel.diffuse.back.angular_exit)));
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) plot.y.high = std::max(plot.y.high, 1.08 * point.y);
  plot.y.high = std::min(plot.y.high, 3.);
  return plot;
}

Plot point_source_plot(const ProfiledChannel& channel) {
  const double length = channel.medium.reduced_mean_free_path();
  const HomogeneousMedium reduced{channel.medium.sigma_a, (1 - channel.medium.g) * channel.medium.sigma_s, 0,
                                  1};
  Plot plot{"Diffusion's fluence around a point source in an endless medium, over the exact one",
            {"distance from the source, mm", .05 * length, 50 * length},
            {"diffusion / exact", .2, 2},
            1};
  PlotSeries classical{"classical diffusion", 1, PlotStyle::curve, {}},
      grosjean{"Grosjean's diffusion, with uncollided light", 3, PlotStyle::curve, {}};
  for (int i = 0; i <= 60; ++i) {
    const double r = .05 * length * std::pow(1000, i / 60.), exact = point_source_fluence(reduced, r);
    if (!(exact > 0)) break;
    classical.points.push_back({r, diffusion_point_fluence(reduced, r) / exact});
    grosjean.points.push_back({r, grosjean_point_fluence(reduced, r) / exact});
  }
  plot.series = {std::move(classical), std::move(grosjean)};
  return plot;
}

}  // namespace opaline
