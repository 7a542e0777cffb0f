// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/volume_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"
#include "quality/picture_cost.h"
#include "quality/settings_search.h"
#include "quality/target_error.h"
#include "quality/volume_cells.h"

namespace opaline {
namespace {

constexpr double kWidest = 3, kFinest = .25;  // cells, mean free paths
constexpr double kErrorOrder = 1.2;           // order of the error in the size of the cells
constexpr double kOfModel = .1;        // error of cells over that of the model: smaller ones hardly help
constexpr double kOfTrial = .15;       // share of the remaining time
constexpr double kWorthSolving = .85;  // largest ratio of new to existing cells
constexpr double kUsualPower = 2.2, kLeastPower = 1.5, kMostPower = 3.3;  // order of the cost in 1 / cell
constexpr std::size_t kEnoughPoints = 1000;

class VolumeBudgetSearch {
 public:
  VolumeBudgetSearch(Session& session, Scene scene, double seconds, Monitor* monitor)
      : search_{session, std::move(scene), monitor}, seconds_(seconds) {
    search_.enough_points = kEnoughPoints;
  }

  TimeBudget run(const FinishPicture& finish);
  Scene take() { return std::move(search_.scene); }

 private:
  /// Solved cells: the smallest of all bodies.
  struct Solved {
    double cell = 0;     ///< mm
    double seconds = 0;  ///< CPU of preparing the bodies
  };

  double spent() const { return watch_.cost({}).cpu_seconds; }
  double left() const { return kPlannedShare * seconds_ - spent() - afterwards_; }
  bool solve(double factor);
  double power() const;
  double factor_for(double seconds) const;
  double factor_of_model() const;

  SettingsSearch search_;
  double seconds_;
  Stopwatch watch_;
  double afterwards_ = 0;  // CPU of shading the image and finishing it
  Solved before_, now_;
  std::optional<double> model_;
};

/// Solves cells of this factor times the size of the existing ones. Returns false if the plan keeps them.
bool VolumeBudgetSearch::solve(double factor) {
  double& size = search_.scene.settings.cell_size;
  const double old =
      std::exchange(size, now_.cell > 0 ? factor * smallest_cell_size(search_.session.plan()) : kWidest);
  search_.session.edit(search_.scene);
  const double cell = smallest_cell(search_.session.plan());
  if (now_.cell > 0 && !(cell < .98 * now_.cell)) {
    size = old;
    search_.session.edit(search_.scene);
    return false;
  }
  const Stopwatch watch;
  search_.prepare();
  before_ =
      std::exchange(now_, {cell, watch.cost({}).cpu_seconds - (now_.cell > 0 ? 0 : search_.bounced_seconds)});
  return true;
}

/// Order of the cost in the inverse of the size.
double VolumeBudgetSearch::power() const {
  if (!(before_.cell > now_.cell)) return kUsualPower;
  return std::clamp(std::log(now_.seconds / before_.seconds) / std::log(before_.cell / now_.cell),
                    kLeastPower, kMostPower);
}

/// Factor of the size for cells of this cost.
double VolumeBudgetSearch::factor_for(double seconds) const {
  return std::pow(now_.seconds / std::max(seconds, 1e-9), 1 / power());
}

/// Factor below which the model's error hides that of the cells.
double VolumeBudgetSearch::factor_of_model() const {
  const double finest = kFinest / smallest_cell_size(search_.session.plan());
  if (!model_ || !(search_.estimated > 0)) return finest;
  return std::max(finest, std::pow(kOfModel * *model_ / search_.estimated, 1 / kErrorOrder));
}

TimeBudget VolumeBudgetSearch::run(const FinishPicture& finish) {
  TimeBudget result;
  search_.begin(search_.scene.settings.tolerance);
  result.sees_translucent = false;
  if (!(search_.most_samples > 0)) return result;
  solve(1);
  const Image picture = search_.first_picture();
  result.sees_translucent = translucent_points(picture) > 0;
  if (!result.sees_translucent) return result;
  model_ = bounded_model_error(search_.session.plan());
  ShadingCost shading(search_.scene, picture);
  afterwards_ =
      shading.of(search_) + search_.bounced_seconds + finishing_cost(picture, search_.scene.film, finish);
  constexpr int kMostTrials = 3;
  for (int i = 0; i < kMostTrials; ++i) {
    const double factor = std::max(factor_for(kOfTrial * left()), factor_of_model());
    if (factor > kWorthSolving || !solve(factor)) break;
    search_.picture();  // its error
  }
  const double by_time = factor_for(left()), by_model = factor_of_model(), cell = now_.cell,
               estimated = search_.estimated;
  const double factor = std::max(by_time, by_model);
  result.at_most = by_model >= by_time;
  double cost = 0;
  if (factor < kWorthSolving) {
    const double seconds = now_.seconds * std::pow(factor, -power());
    search_.scene.settings.cell_size = factor * smallest_cell_size(search_.session.plan());
    search_.session.edit(search_.scene);
    const double planned = smallest_cell(search_.session.plan());
    result.at_most = result.at_most || planned > 1.02 * factor * cell;
    if (planned < .98 * cell) cost = seconds * std::pow(factor * cell / planned, power());
  }
  const double error = estimated * std::pow(smallest_cell(search_.session.plan()) / cell, kErrorOrder);
  result.of_settings = error;
  if (model_) result.predicted = std::hypot(*model_, error);
  result.planned = spent() + cost + afterwards_;
  result.fits = result.planned <= seconds_;
  return result;
}

}  // namespace

TimeBudget fit_cells(Session& session, Scene& scene, double seconds, const FinishPicture& finish,
                     Monitor* monitor) {
  VolumeBudgetSearch search(session, scene, seconds, monitor);
  const TimeBudget result = search.run(finish);
  if (result.sees_translucent) scene = search.take();
  return result;
}

}  // namespace opaline
