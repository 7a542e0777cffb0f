// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/volume_cells.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

// Largest ratio of actual to expected model error, over the bodies of bench_volume_models and target_error_against_walks.
constexpr double kModelSafety = 1.4;

template <class Length>
double smallest(const Plan& plan, const Length& of) {
  double least = INFINITY;
  for (const BodyPlan& group : plan.groups)
    if (group.method == Method::volume_diffusion) least = std::min(least, of(group));
  return least;
}

}  // namespace

double smallest_cell(const Plan& plan) {
  return smallest(plan, [](const BodyPlan& group) { return group.cell; });
}

double smallest_cell_size(const Plan& plan) {
  return smallest(plan, [](const BodyPlan& group) { return group.cell / group.smallest_mean_free_path; });
}

std::optional<double> bounded_model_error(const Plan& plan) {
  double worst = 0;
  for (const BodyPlan& group : plan.groups) {
    const std::optional<double> expected = group.model.expected_error_of_diffusion;
    if (group.method != Method::volume_diffusion || !expected) return {};
    worst = std::max(worst, kModelSafety * *expected);
  }
  return worst;
}

}  // namespace opaline
