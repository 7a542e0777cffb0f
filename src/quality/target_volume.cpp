// SPDX-License-Identifier: GPL-3.0-or-later
// Cells, samples and shadow rays of bodies with cells for a target error against random walks.
#include <algorithm>
#include <cmath>
#include <utility>

#include "lights/light.h"
#include "quality/probe.h"
#include "quality/settings_search.h"
#include "quality/target_error.h"
#include "quality/volume_cells.h"
#include "volume/volume_diffusion.h"

namespace opaline {
namespace {

// Least fraction for cells, samples and shadow rays if the model error uses all of the target: 4 % of the
// promise.
constexpr double kLeastShare = .3;
constexpr double kCoarsest = 3, kFinest = .25;  // cells, mean free paths
constexpr double kMargin = .85;                 // margin of the target error: two steps cost more than one
constexpr int kMostSteps = 6, kMostLightSamples = 4096;
constexpr double kQuickCells = 3e5;  // solved in about a second

double all_cells(const Plan& plan) {
  double cells = 0;
  for (const BodyPlan& group : plan.groups)
    if (group.method == Method::volume_diffusion)
      cells += expected_cells(group.area, group.thickness, group.cell);
  return cells;
}

class VolumeSearch {
 public:
  VolumeSearch(Session& session, Scene scene, Monitor* monitor)
      : search_{session, std::move(scene), monitor} {
    search_.probe_pixels = kTargetPixels;
    search_.enough_points = kTargetPoints;
    search_.begin(search_.scene.settings.tolerance);
  }

  const Plan& plan() const { return search_.session.plan(); }
  bool has_samples() const { return search_.most_samples > 0; }
  std::size_t samples() const { return search_.planned_samples(); }
  double estimated() const { return estimated_; }
  Scene take() { return std::move(search_.scene); }

  /// Sets this cell size. Returns false, without changes, if the plan does not allow it.
  bool try_cells(double mean_free_paths) {
    Settings& settings = search_.scene.settings;
    const double before = std::exchange(settings.cell_size, mean_free_paths);
    search_.session.edit(search_.scene);
    const double planned = smallest_cell(plan());
    if (!(planned < .95 * cell_)) {
      settings.cell_size = before;
      search_.session.edit(search_.scene);
      return false;
    }
    search_.prepare();
    picture_ = search_.first_picture();
    cell_ = planned;
    estimated_ = search_.estimated;
    return true;
  }

  bool sees_translucent() const { return translucent_points(picture_) > 0; }

  /// Quadruples the shadow rays while that changes the image significantly. For many cells, tested with
  /// larger ones, which have the same noise.
  void settle_light(double most) {
    Settings& settings = search_.scene.settings;
    if (std::ranges::all_of(search_.scene.lights, is_delta)) return;
    const double cell_size = settings.cell_size, cells = all_cells(plan());
    if (cells > kQuickCells) {
      settings.cell_size *= std::sqrt(cells / kQuickCells);
      search_.prepare();
      picture_ = search_.picture();
    }
    for (double change = 2 * most; change > most && settings.light_samples < kMostLightSamples;) {
      settings.light_samples *= 4;
      const Image before = std::move(picture_);
      search_.session.edit(search_.scene);
      search_.session.prepare(search_.monitor);
      picture_ = search_.picture();
      change = probe_difference(before, picture_);
    }
    settings.cell_size = cell_size;
  }

 private:
  SettingsSearch search_;
  Image picture_;
  double cell_ = INFINITY, estimated_ = 0;
};

}  // namespace

Scene with_named_method(const Session& session) {
  Scene scene = session.scene();
  if (scene.settings.method != Method::automatic) return scene;
  const std::vector<BodyPlan>& bodies = session.plan().groups;
  const auto has_cells = [](const BodyPlan& body) { return body.method == Method::volume_diffusion; };
  if (std::ranges::none_of(bodies, has_cells))
    scene.settings.method = Method::hierarchical;
  else if (std::ranges::all_of(bodies, has_cells))
    scene.settings.method = Method::volume_diffusion;
  return scene;
}

TargetError reach_volume_error(Session& session, Scene scene, double target, Monitor* monitor) {
  VolumeSearch search(session, scene, monitor);
  TargetError result;
  result.sees_translucent = false;
  if (search.has_samples()) {
    search.try_cells(kCoarsest);
    result.sees_translucent = search.sees_translucent();
  }
  if (!result.sees_translucent) {
    session.edit(std::move(scene));
    return result;
  }
  result.model = bounded_model_error(search.plan());
  const double model = result.model.value_or(0),
               promised = std::max(target, std::hypot(1, kLeastShare) * model),
               left = std::sqrt(promised * promised - model * model);
  double cells = std::min(kCoarsest, smallest_cell_size(search.plan()));
  for (int step = 0; step < kMostSteps && search.estimated() > left && cells > kFinest; ++step) {
    cells = std::max(kFinest, cells * std::min(.9, kMargin * left / search.estimated()));
    if (!search.try_cells(cells)) break;
    cells = smallest_cell_size(search.plan());
  }
  search.settle_light(.5 * left);
  result.of_settings = search.estimated();
  result.predicted = std::hypot(model, result.of_settings);
  result.promised = promised;
  result.reached = result.model && result.predicted <= target;
  result.samples = search.samples();
  session.edit(search.take());
  return result;
}

}  // namespace opaline
