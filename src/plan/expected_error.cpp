// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/expected_error.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "subsurface/method.h"

namespace opaline {

std::optional<double> expected_error(const BodyModel& model, Method method) {
  if (!method_of(method).has_model()) return {};
  return method_of(method).expected_error(model);
}

std::optional<double> expected_model_error(const Plan& plan) {
  std::optional<double> largest;
  for (const BodyPlan& group : plan.groups)
    if (const std::optional<double> error = expected_error(group.model, group.method))
      largest = std::max(largest.value_or(0), *error);
  return largest;
}

std::vector<std::string> bodies_of_unknown_error(const Plan& plan) {
  std::vector<std::string> names;
  for (const BodyPlan& group : plan.groups)
    if (method_of(group.method).has_model() && !expected_error(group.model, group.method))
      names.push_back(group.name);
  return names;
}

std::vector<std::string> model_warnings(const Plan& plan) {
  constexpr double kLarge = .2, kBetter = .7;  // bounds of the error
  std::vector<std::string> warnings;
  for (const BodyPlan& group : plan.groups) {
    const std::optional<double> error = expected_error(group.model, group.method);
    if (!error || *error <= kLarge) continue;
    const std::optional<double>& other = group.model.expected_error_of_diffusion;
    const std::string better = other && *other < kBetter * *error
                                   ? "--method volume_diffusion: " + short_percent(*other)
                                   : "--method volume is the reference";
    warnings.push_back(
        fmt::format("{}: expected model error {}; {}", group.name, short_percent(*error), better));
  }
  return warnings;
}

}  // namespace opaline
