// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "quality/target_error.h"
#include "scene/names.h"

namespace opaline {

std::vector<std::string> chosen_overrides(const Session& session, std::size_t entry_samples) {
  if (session.scene().lights.empty()) return {};  // nothing was chosen
  const Settings& settings = session.scene().settings;
  if (settings.method == Method::direct) return {fmt::format("settings.entry_samples={}", entry_samples)};
  const std::string method = fmt::format("settings.method={}", name_of(settings.method));
  if (settings.method != Method::hierarchical)
    return {method, fmt::format("settings.cell_size={}", settings.cell_size)};
  std::vector<std::string> overrides{method, fmt::format("settings.tolerance={}", settings.tolerance),
                                     fmt::format("settings.evaluator={}", name_of(settings.evaluator))};
  const std::vector<BodyPlan>& groups = session.plan().groups;
  if (groups.size() == 1)
    overrides.push_back(fmt::format("settings.samples={}", groups[0].samples));
  else if (settings.sample_spacing)
    overrides.push_back(
        fmt::format("settings.sample_spacing={}", *settings.sample_spacing / session.scene().mm_per_unit));
  return overrides;
}

}  // namespace opaline
