// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/quality.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/names.h"
#include "opaline/core/error.h"

namespace opaline {
namespace {

constexpr double kKnownShare = 0.4;

Error bad_usage(const std::string& message, const std::string& expected, const std::string& got = {}) {
  return Error(ErrorKind::bad_input, {}, 0, 0, message, expected, got);
}

}  // namespace

void check_quality(const RenderArguments& render) {
  if (!render.target_error) return;
  for (const char* key : {"settings.samples", "settings.sample_spacing", "settings.tolerance"})
    for (const std::string& text : render.overrides)
      if (text.starts_with(std::string(key) + "="))
        throw bad_usage(fmt::format("--target-error chooses {} itself", key), "one of the two", text);
  if (!render.frames.empty())
    throw bad_usage("--target-error chooses for one picture, and frames would flicker",
                    "a single picture first, then --frames with its settings.samples and tolerance");
}

std::optional<TargetError> choose_settings(StageRunner& stages, const RenderArguments& arguments,
                                           Session& session) {
  const Settings& settings = session.scene().settings;
  const bool hierarchical = settings.method == Method::hierarchical;
  if (!hierarchical && (arguments.target_error || arguments.verify))
    throw bad_usage(arguments.target_error ? "--target-error chooses how light under the surface is summed"
                                           : "--verify measures how light under the surface is summed",
                    "--method hierarchical; the noise of direct ends at --until-error",
                    name_of(settings.method));
  if (!arguments.target_error) return {};
  if (settings.evaluator == EvaluatorKind::classic)
    throw bad_usage("--target-error cannot tell the error of the classic traversal", "another --evaluator",
                    "classic");
  const TargetError chosen = stages.run("choosing", [&] {
    return reach_error(session, session.scene(), *arguments.target_error, &stages.monitor());
  });
  print_target(arguments.log, *arguments.target_error, chosen, session.scene().settings);
  return chosen;
}

std::optional<MeasuredError> verify_picture(StageRunner& stages, const RenderArguments& arguments,
                                            const Session& session, const std::optional<TargetError>& chosen,
                                            const Image& picture) {
  if (!arguments.verify || session.groups().empty()) return {};
  // An error far below the target need not be known to its last digit.
  const double expected = chosen ? std::max(chosen->predicted, kKnownShare * *arguments.target_error)
                                 : estimated_relative_error(picture);
  return stages.run("verifying", [&] { return measure_error(session, expected, &stages.monitor()); });
}

}  // namespace opaline
