// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/quality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/render_outputs.h"
#include "core/atomic_file.h"
#include "core/units.h"
#include "input/load_scene.h"
#include "opaline/error.h"
#include "plan/expected_error.h"
#include "scene/names.h"

namespace opaline {
namespace {

constexpr double kKnownShare = 0.4;

Error bad_usage(const std::string& message, const std::string& expected, const std::string& got = {}) {
  return Error(ErrorKind::bad_input, {}, 0, 0, message, expected, got);
}

/// Checks that settings can express the choice: several bodies share one spacing.
void check_groups(const Session& session, const char* option) {
  if (session.scene().settings.samples && session.plan().groups.size() > 1)
    throw bad_usage(fmt::format("{} chooses the sample spacing, and so the samples of each body", option),
                    "no settings.samples in the scene file");
}

/// The given option of the two; "" for neither.
const char* option_of(const RenderArguments& render) {
  return render.target_error ? "--target-error" : render.time_budget ? "--time-budget" : "";
}

void check_cells(const RenderArguments& arguments) {
  for (const std::string& text : arguments.overrides)
    if (text.starts_with("settings.cell_size="))
      throw bad_usage(fmt::format("{} chooses settings.cell_size itself", option_of(arguments)),
                      "one of the two", text);
}

/// With cells in all bodies, or in some of them (with_named_method).
bool chooses_cells(const Settings& settings) {
  return settings.method == Method::volume_diffusion || settings.method == Method::automatic;
}

KnownErrors fit_settings(StageRunner& stages, const RenderArguments& arguments, Session& session) {
  const double before = process_cpu_seconds();
  const Scene scene = session.scene();
  if (chooses_cells(scene.settings))
    check_cells(arguments);
  else
    check_groups(session, "--time-budget");
  const TimeBudget chosen = stages.run(
      "choosing",
      [&] {
        return fit_budget(session, scene, budget_left(arguments, scene), trial_writing(arguments, scene.film),
                          &stages.monitor());
      },
      InnerStages::trials);
  print_budget(arguments.log, *arguments.time_budget, before, chosen, session.scene().settings);
  return {{}, chosen.of_settings, {}};
}

KnownErrors choose_cells(StageRunner& stages, const RenderArguments& arguments, Session& session) {
  check_cells(arguments);
  const double target = *arguments.target_error;
  const TargetError chosen = stages.run(
      "choosing", [&] { return reach_volume_error(session, session.scene(), target, &stages.monitor()); },
      InnerStages::trials);
  print_volume_target(arguments.log, target, chosen, session.scene().settings);
  KnownErrors known{target, {}, {}};
  if (chosen.sees_translucent) known.predicted = chosen.of_settings;
  return known;
}

void warn_of_unlit(const Log& log, const char* option) {
  print_warning(log, fmt::format("the scene has no lights, so {} has no effect", option));
}

void check_budget(const RenderArguments& render) {
  if (render.target_error)
    throw bad_usage("--time-budget and --target-error both choose the settings", "one of the two");
  if (!render.frames.empty())
    throw bad_usage("--time-budget chooses settings for one image, so frames would flicker",
                    "a single image first, then --frames with the settings of its closing lines");
  if (!render.cache.empty())
    throw bad_usage("--time-budget measures the cost of the stages, and stages from --cache have none",
                    "one of the two");
  const std::pair<bool, const char*> unplanned[] = {
      {!render.samples_ply.empty(), "--samples-ply"},
      {!render.resume.empty(), "--resume"},
      {is_named(render.layers, kLightGroups), "--layers light_groups"},
      {is_named(render.layers, kCryptomatte), "--layers cryptomatte"}};
  for (const auto& [given, option] : unplanned)
    if (given) throw bad_usage(fmt::format("--time-budget does not plan for {}", option), "one of the two");
}

/// Warns if the target of radial profiles leaves out their model error.
void warn_of_model(const Log& log, const Plan& plan) {
  const std::vector<std::string> unknown = bodies_of_unknown_error(plan);
  const std::optional<double> expected = expected_model_error(plan);
  print_warning(log,
                fmt::format("--target-error leaves out the error of the model against --method volume: {}",
                            !unknown.empty() ? fmt::format("unknown for {}", fmt::join(unknown, ", "))
                            : expected       ? "about " + short_percent(*expected)
                                             : std::string("unknown")));
}

}  // namespace

void check_quality(const RenderArguments& render) {
  if (render.time_budget) check_budget(render);
  if (!chooses_settings(render)) return;
  for (const char* key : {"settings.samples", "settings.sample_spacing", "settings.tolerance"})
    for (const std::string& text : render.overrides)
      if (text.starts_with(std::string(key) + "="))
        throw bad_usage(fmt::format("{} chooses {} itself", option_of(render), key), "one of the two", text);
}

void name_method(const RenderArguments& arguments, Session& session) {
  if (session.scene().settings.method != Method::automatic) return;
  if (!chooses_settings(arguments) && !arguments.verify) return;
  Scene scene = with_named_method(session);
  if (arguments.verify) scene.settings.method = Method::hierarchical;
  session.edit(std::move(scene));
  if (arguments.target_error && session.scene().settings.method == Method::hierarchical &&
      !arguments.verify && !session.plan().groups.empty())
    warn_of_model(arguments.log, session.plan());
}

bool chooses_settings(const RenderArguments& arguments) {
  return arguments.time_budget || arguments.target_error;
}

double budget_left(const RenderArguments& arguments, const Scene& scene) {
  // A spent budget counts as 1 ms, and is reported as too small.
  return std::max(1e-3, *arguments.time_budget - process_cpu_seconds()) /
         double(1 + scene.other_wavelengths.size());
}

Plan announced_plan(const RenderArguments& arguments, const Session& session, std::size_t more_bytes) {
  Plan plan = session.plan();
  plan.bytes += more_bytes;
  const Settings& settings = session.scene().settings;
  if (arguments.time_budget && settings.method == Method::direct && !settings.entry_samples &&
      !settings.until_error)
    plan.stages.back() = "shading: direct, until the end of --time-budget";
  return plan;
}

void warn_of_little_time(const RenderArguments& arguments, const Film& film, double spent,
                         const std::optional<DirectResult>& direct) {
  if (!direct || direct->entry_samples > entry_samples_per_pass(film) || spent <= *arguments.time_budget)
    return;
  print_warning(arguments.log,
                fmt::format("a budget of {:.4g} s of CPU is too small: opaline renders a single pass of "
                            "direct, in {:.2g} s; fewer pixels reduce the cost",
                            *arguments.time_budget, spent));
}

void warn_of_unlit_options(const RenderArguments& arguments, const Scene& scene) {
  if (!scene.lights.empty()) return;
  const std::pair<bool, const char*> options[] = {{arguments.verify, "--verify"},
                                                  {arguments.gives_until_error, "--until-error"},
                                                  {arguments.gives_entry_samples, "--entry-samples"},
                                                  {!arguments.resume.empty(), "--resume"}};
  for (const auto& [given, option] : options)
    if (given) warn_of_unlit(arguments.log, option);
}

RenderArguments settled_for_frames(const RenderArguments& arguments, StageCache* cache) {
  const int reference = load_scene(arguments.scene, arguments.overrides).settings.reference_frame;
  StageRunner stages(arguments.log);
  Session session(cache);
  stages.run_unmeasured("loading", [&] {
    Scene scene = load_scene(arguments.scene, arguments.overrides, reference);
    session.expect_pictures(scene.camera_frames);
    session.edit(std::move(scene));
  });
  name_method(arguments, session);
  check_groups(session, "--target-error with --frames");
  RenderArguments settled = arguments;
  const KnownErrors known = choose_settings(stages, arguments, session);
  settled.target_error.reset();
  if (!known.predicted && !chooses_cells(session.scene().settings)) return settled;
  for (std::string& text : chosen_overrides(session, 0)) settled.overrides.push_back(std::move(text));
  settled.overrides.push_back(
      fmt::format("settings.light_samples={}", session.scene().settings.light_samples));
  return settled;
}

FinishPicture trial_writing(const RenderArguments& arguments, const Film& film) {
  return [&arguments, &film](const Image& picture) {
    for (const std::string& path : arguments.outputs) {
      const AtomicFile trial(path);  // never committed
      write_picture(trial.temporary(), picture, film, arguments.layers);
    }
  };
}

KnownErrors choose_settings(StageRunner& stages, const RenderArguments& arguments, Session& session) {
  if (session.scene().lights.empty()) {  // a black image has no error
    if (chooses_settings(arguments)) warn_of_unlit(arguments.log, option_of(arguments));
    return {};
  }
  const Settings& settings = session.scene().settings;
  if (arguments.time_budget && settings.method == Method::lambert)
    throw bad_usage("--time-budget requires hierarchical evaluation, volume_diffusion or direct",
                    "--method hierarchical, volume_diffusion or direct",
                    std::string(name_of(settings.method)));
  if (arguments.time_budget && settings.method == Method::volume)
    throw bad_usage("--time-budget cannot stop random walks", "--until-error, and --resume to continue later",
                    "volume");
  const bool hierarchical = settings.method == Method::hierarchical;
  if (chooses_cells(settings) && !arguments.verify) {
    if (arguments.target_error) return choose_cells(stages, arguments, session);
    if (arguments.time_budget) return fit_settings(stages, arguments, session);
  }
  if (!hierarchical && (arguments.target_error || arguments.verify))
    throw bad_usage(arguments.target_error
                        ? "--target-error requires hierarchical evaluation or volume_diffusion"
                        : "--verify requires hierarchical evaluation or volume_diffusion",
                    arguments.verify ? "--method hierarchical; compare volume_diffusion with --method volume"
                                     : "--method hierarchical or volume_diffusion; use --until-error for the "
                                       "noise of direct and volume",
                    std::string(name_of(settings.method)));
  if (!chooses_settings(arguments) || !hierarchical) return {};
  if (settings.evaluator == EvaluatorKind::classic)
    throw bad_usage(
        fmt::format("{} cannot estimate the error of the classic traversal", option_of(arguments)),
        "another --evaluator", "classic");
  if (arguments.time_budget) return fit_settings(stages, arguments, session);
  const TargetError chosen = stages.run(
      "choosing",
      [&] { return reach_error(session, session.scene(), *arguments.target_error, &stages.monitor()); },
      InnerStages::trials);
  print_target(arguments.log, *arguments.target_error, chosen, session.scene().settings);
  KnownErrors errors{arguments.target_error, {}, {}};
  if (chosen.sees_translucent) errors.predicted = chosen.predicted;
  return errors;
}

std::optional<MeasuredError> verify_picture(StageRunner& stages, const RenderArguments& arguments,
                                            const Session& session, const KnownErrors& errors,
                                            const RenderResult& picture) {
  if (!arguments.verify || session.scene().lights.empty()) return {};
  if (session.bodies().empty()) {
    print_warning(arguments.log, "the scene has no translucent shape, so --verify measures nothing");
    return {};
  }
  // An error far below the target is not measured to its last digit.
  const double expected = errors.predicted
                              ? std::max(*errors.predicted, kKnownShare * errors.target.value_or(0))
                              : settings_error(picture);
  try {
    const MeasuredError measured = stages.run(
        "verifying", [&] { return measure_error(session, expected, &stages.monitor()); },
        InnerStages::trials);
    if (measured.points == 0)
      print_warning(arguments.log, "no translucent object is visible, so --verify measures nothing");
    return measured;
  } catch (const Error& stopped) {
    if (stopped.kind != ErrorKind::interrupted) throw;
    throw Error(ErrorKind::interrupted, {}, 0, 0, "interrupted during --verify; the image is written");
  }
}

}  // namespace opaline
