// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/regression.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

constexpr double kLeast = .05;  // smallest significant change, relative to the earlier value
constexpr double kStandardErrors = 3;

bool is_other_ratio(const Spread& before, const Spread& now) {
  if (before.runs == 0 || now.runs == 0) return false;
  const double gap = std::max(now.low - before.high, before.low - now.high);
  const double widths = (before.high - before.low) + (now.high - now.low);
  return gap > widths / 2 && std::abs(now.median - before.median) > kLeast * before.median;
}

/// error_floor^2 is twice the square's standard error.
bool is_other_error(const WatchedRung& before, const WatchedRung& now) {
  if (!before.has_error || !now.has_error) return false;
  const auto square = [](double error) { return std::copysign(error * error, error); };
  const double noise = std::hypot(square(before.error_floor), square(now.error_floor)) / 2;
  return std::abs(square(now.error) - square(before.error)) > kStandardErrors * noise &&
         std::abs(now.error - before.error) > kLeast * std::abs(before.error);
}

void add_changes(const WatchedRung& before, const WatchedRung& now, std::vector<Change>& changes) {
  const auto add = [&](const char* figure, double was, double is) {
    changes.push_back({now.title, now.rung, figure, was, is, is > was});
  };
  if (is_other_ratio(before.job_ratio, now.job_ratio))
    add("job x lambert", before.job_ratio.median, now.job_ratio.median);
  if (is_other_ratio(before.shading_ratio, now.shading_ratio))
    add("shading x lambert", before.shading_ratio.median, now.shading_ratio.median);
  if (is_other_error(before, now)) add("error", before.error, now.error);
}

auto same_rung(const WatchedRung& a) {
  return [&a](const WatchedRung& b) { return a.key == b.key && a.rung == b.rung; };
}

}  // namespace

Regression compare_results(std::span<const WatchedRung> before, std::span<const WatchedRung> now) {
  Regression result;
  for (const WatchedRung& rung : now) {
    const auto match = std::ranges::find_if(before, same_rung(rung));
    if (match == before.end()) {
      result.unmatched.push_back(rung.title + " " + rung.rung);
      continue;
    }
    ++result.compared;
    add_changes(*match, rung, result.changes);
  }
  for (const WatchedRung& rung : before)
    if (std::ranges::none_of(now, same_rung(rung))) result.unmatched.push_back(rung.title + " " + rung.rung);
  return result;
}

}  // namespace opaline
