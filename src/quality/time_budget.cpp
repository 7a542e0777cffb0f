// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/time_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/stopwatch.h"
#include "quality/picture_cost.h"
#include "quality/probe.h"
#include "quality/settings_search.h"
#include "quality/volume_budget.h"

namespace opaline {
namespace {

constexpr double kFewest = 2500;             // samples
constexpr std::size_t kEnoughPoints = 1000;  // enough points of a small image
constexpr double kFirstTolerance = .01;
// Maximum factor of the samples of a small image; these cost a few per cent then.
constexpr double kBeyond = 8;
// Least factor of new samples over existing ones, as existing samples cost less.
constexpr double kWorthPlacing = 1.25;
// Least fraction of the time in shading for trying the surface cache.
constexpr double kWorthCaching = 0.3;

/// Tried number of samples, with its small image. CPU, s.
struct Tried {
  double samples = 0;
  Image picture;
  double sampling = 0;
  double preparing = 0;  ///< sampling, irradiance, octree, bounces
  double shading = 0;    ///< cost of shading the whole image
  double looking = 0;    ///< other costs of the trial
};

struct Choice {
  double samples = 0, cost = 0;  // CPU of preparing and shading, s
};

double cost_of(const Session& session, std::initializer_list<std::string_view> stages) {
  double seconds = 0;
  for (const StageCost& cost : session.costs())
    if (std::ranges::find(stages, cost.stage) != stages.end()) seconds += cost.cpu_seconds;
  return seconds;
}

Tried tried(const Session& session, double samples, Image picture) {
  return {samples, std::move(picture), cost_of(session, {"sampling"}),
          cost_of(session, {"sampling", "irradiance", "octree", "bounces"})};
}

class BudgetSearch {
 public:
  BudgetSearch(Session& session, Scene scene, double seconds, Monitor* monitor)
      : search_{session, std::move(scene), monitor}, seconds_(seconds) {
    search_.enough_points = kEnoughPoints;
  }

  TimeBudget run(const FinishPicture& finish);
  Scene chosen() { return std::move(search_.scene); }

 private:
  double spent() const { return watch_.cost({}).cpu_seconds; }
  double left() const { return kPlannedShare * seconds_ - spent() - finishing_; }
  const Tried& last() const { return tried_.back(); }

  void try_first(const FinishPicture& finish);
  void try_samples(double samples);
  void try_more();
  double goal() const;
  bool is_worth_trying(double samples) const;
  double growth() const;
  double preparing(double samples) const;
  Choice affordable(double most, double exitance = 0) const;
  double error_guess() const;
  std::optional<double> predicted(double samples) const;
  Choice with_tolerance();
  Choice with_evaluator(Choice plan);

  SettingsSearch search_;
  double seconds_;
  Stopwatch watch_;
  double finishing_ = 0, slope_ = kUsualSlope, interpolation_ = 0;
  std::vector<Tried> tried_;
  int doubled_ = 0;  // times in a row
  std::optional<ShadingCost> shading_;
  std::optional<double> error_;  // error of the last tried
};

void BudgetSearch::try_first(const FinishPicture& finish) {
  const double samples = std::min(kFewest, search_.most_samples / 4);
  search_.place(samples);
  Image picture = search_.first_picture();
  Tried& first = tried_.emplace_back(tried(search_.session, samples, std::move(picture)));
  shading_.emplace(search_.scene, first.picture);
  const Stopwatch looking;
  first.shading = shading_->of(search_);
  first.looking = looking.cost({}).cpu_seconds;
  // The final scene, including opaque surfaces.
  Scene whole = probe_scene(search_.scene, search_.probe_pixels);
  whole.shapes = search_.scene.shapes;
  const Session& session = search_.session;
  RenderInput input{whole, session.world(), session.rays(), session.bodies(), search_.monitor};
  input.bounced = search_.bounced;
  finishing_ = search_.bounced_seconds + finishing_cost(render(input).image, search_.scene.film, finish);
}

void BudgetSearch::try_samples(double samples) {
  search_.scene.settings.tolerance =
      tolerance_for(error_guess() * std::pow(last().samples / samples, slope_));
  const Stopwatch watch;
  Image picture = search_.picture_of(samples);
  Tried next = tried(search_.session, samples, std::move(picture));
  next.shading = shading_->of(search_);
  next.looking = watch.cost({}).cpu_seconds - next.preparing;
  tried_.push_back(std::move(next));
  doubled_ = std::abs(samples / tried_[tried_.size() - 2].samples - 2) < .01 ? doubled_ + 1 : 0;
  error_.reset();
  if (doubled_ < 2) return;
  const std::size_t n = tried_.size();
  const Image &a = tried_[n - 1].picture, &b = tried_[n - 2].picture, &c = tried_[n - 3].picture;
  slope_ = error_slope(probe_difference(c, b), probe_difference(b, a));
  error_ = probe_error(a, b, c);
}

/// Approximate mean relative error of the last trial.
double BudgetSearch::error_guess() const {
  if (error_) return *error_;
  if (tried_.size() < 2) return 2 * kFirstTolerance;
  const Tried& before = tried_[tried_.size() - 2];
  return probe_difference(before.picture, last().picture) /
         (std::pow(last().samples / before.samples, slope_) - 1);
}

/// Order of the shading cost in the number of samples.
double BudgetSearch::growth() const {
  constexpr double kMost = 0.7;
  if (tried_.size() < 2) return 0;
  const Tried& before = tried_[tried_.size() - 2];
  return std::clamp(std::log(last().shading / before.shading) / std::log(last().samples / before.samples),
                    0.0, kMost);
}

/// Linear with a fixed part of sampling.
double BudgetSearch::preparing(double samples) const {
  constexpr double kFixed = 0.7;  // fixed part of the cost of sampling
  const Tried &first = tried_.front(), &now = last();
  if (samples == now.samples) return 0;
  const double least = 0.3 * now.preparing / now.samples, most = now.preparing / now.samples;
  const double each = tried_.size() == 1 ? (now.preparing - kFixed * now.sampling) / now.samples
                                         : (now.preparing - first.preparing) / (now.samples - first.samples);
  return now.preparing + std::clamp(each, least, most) * (samples - now.samples);
}

/// Samples fitting into the time; those of the last trial are free.
Choice BudgetSearch::affordable(double most, double exitance) const {
  const double power = growth();
  const auto cost = [&](double samples) {
    return preparing(samples) + (last().shading + (samples > last().samples ? exitance : 0)) *
                                    std::pow(samples / last().samples, power);
  };
  double low = last().samples, high = std::min(most, search_.most_samples);
  if (high > low && cost(high) <= left()) return {high, cost(high)};
  for (int i = 0; i < 40 && high > low; ++i) {
    const double middle = std::sqrt(low * high);
    (cost(middle) <= left() ? low : high) = middle;
  }
  if (low < kWorthPlacing * last().samples) low = last().samples;
  return {low, cost(low)};
}

/// Samples for the last small image.
double BudgetSearch::goal() const {
  return std::min(affordable(search_.most_samples).samples / kBeyond, search_.most_samples);
}

/// True if the trial and its image fit into the time, or are cheaper than the current image.
bool BudgetSearch::is_worth_trying(double samples) const {
  double shading = 0.75 * last().shading;  // near light is expensive with few samples
  if (tried_.size() > 1) {
    const double ratio = last().shading / tried_[tried_.size() - 2].shading;
    shading = last().shading * std::clamp(ratio, 0.6, 1.5);
  }
  const double trying = preparing(samples) + last().looking;
  return trying + shading <= left() || trying + shading < last().shading;
}

/// Estimates the error from three images, each with twice the samples of the one before, the last near the
/// goal.
void BudgetSearch::try_more() {
  for (;;) {
    const double goal = this->goal(), now = last().samples;
    if (doubled_ >= 2 && now > goal / std::sqrt(2)) return;
    const double next = doubled_ == 0 && goal / 4 > 2 * now ? goal / 4 : 2 * now;
    if (next > search_.most_samples || !is_worth_trying(next)) return;
    try_samples(next);
  }
}

std::optional<double> BudgetSearch::predicted(double samples) const {
  if (!error_) return {};
  return std::hypot(*error_ * std::pow(last().samples / samples, slope_), interpolation_);
}

/// The matching tolerance, with its cost.
Choice BudgetSearch::with_tolerance() {
  const Choice rough = affordable(kBeyond * last().samples);
  const double tolerance = tolerance_for(error_guess() * std::pow(last().samples / rough.samples, slope_));
  search_.scene.settings.tolerance = std::stod(fmt::format("{:.2g}", tolerance));  // few digits
  tried_.back().shading = shading_->of(search_);
  return affordable(2 * kBeyond * last().samples);
}

/// A surface cache if it frees time for samples worth more than its interpolation error.
Choice BudgetSearch::with_evaluator(Choice plan) {
  if (last().shading < kWorthCaching * left()) return plan;
  const Image exact = search_.picture();
  if (search_.try_surface_cache()) {
    const double exact_shading = last().shading, exitance = cost_of(search_.session, {"exitance"});
    tried_.back().shading = shading_->of(search_);
    const Choice cached = affordable(2 * kBeyond * last().samples, exitance);
    interpolation_ = probe_difference(search_.picture(), exact);
    const double guess = error_guess();
    const auto error = [&](const Choice& p, double more) {
      return std::hypot(guess * std::pow(last().samples / p.samples, slope_), more);
    };
    const bool both_fit = std::max(plan.cost, cached.cost) <= left();
    if (both_fit ? error(cached, interpolation_) < error(plan, 0) : cached.cost < plan.cost) return cached;
    interpolation_ = 0;
    tried_.back().shading = exact_shading;
  }
  search_.scene.settings.evaluator = EvaluatorKind::dual_tree;
  return affordable(2 * kBeyond * last().samples);
}

TimeBudget BudgetSearch::run(const FinishPicture& finish) {
  const bool open = search_.scene.settings.evaluator == EvaluatorKind::automatic;
  TimeBudget result;
  search_.begin(kFirstTolerance);
  if (search_.most_samples > 0) try_first(finish);
  result.sees_translucent = search_.most_samples > 0 && translucent_points(last().picture) > 0;
  if (!result.sees_translucent) return result;
  try_more();
  Choice plan = with_tolerance();
  if (open) plan = with_evaluator(plan);
  result.predicted = result.of_settings = predicted(plan.samples);
  result.at_most = plan.samples > 0.999 * search_.most_samples;
  result.planned = spent() + plan.cost + finishing_;
  result.fits = result.planned <= seconds_;
  search_.scene.settings.sample_spacing = std::sqrt(search_.area / plan.samples);
  return result;
}

}  // namespace

TimeBudget fit_budget(Session& session, Scene scene, double seconds, const FinishPicture& finish,
                      Monitor* monitor) {
  TimeBudget result;
  if (scene.settings.method != Method::hierarchical) {
    result = fit_cells(session, scene, seconds, finish, monitor);
  } else {
    BudgetSearch search(session, scene, seconds, monitor);
    result = search.run(finish);
    if (result.sees_translucent) scene = search.chosen();
  }
  session.edit(std::move(scene));
  for (const BodyPlan& group : session.plan().groups) result.samples += group.samples;
  return result;
}

}  // namespace opaline
