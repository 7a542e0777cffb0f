// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <numeric>
#include <optional>

#include "bodies/plan.h"
#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/metadata.h"
#include "cli/movie.h"
#include "cli/quality.h"
#include "cli/render_outputs.h"
#include "cli/render_part.h"
#include "cli/report.h"
#include "cli/resumable_state.h"
#include "cli/stages.h"
#include "core/machine_memory.h"
#include "core/units.h"
#include "image/denoise.h"
#include "input/load_scene.h"
#include "methods/direct/direct.h"
#include "methods/volume/volume_state.h"
#include "opaline/error.h"
#include "plan/expected_error.h"
#include "plan/expected_seconds.h"
#include "plan/make_plan.h"
#include "plan/picture_warnings.h"
#include "plan/placement_warnings.h"
#include "plan/seen_pixels.h"
#include "plan/shapes_inside.h"
#include "render/adaptive_rays.h"
#include "render/layers.h"
#include "render/render.h"
#include "scene/names.h"
#include "session/scene_hash.h"
#include "session/session_records.h"
#include "session/spectral_image.h"
#include "subsurface/method.h"
#include "volume/volume_diffusion.h"

namespace opaline {
namespace {

/// in    more_bytes: in addition to the plan
/// error Error{run_failed}: the plan exceeds the memory available to this process; suggests smaller settings
void check_memory(const Scene& scene, const Plan& plan, std::size_t more_bytes) {
  // The full image needs address space, including empty parts.
  const Rectangle part = rendered_part(scene.film);
  const std::size_t picture = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0) *
                              layer_names(method_of(scene.settings.method).layers()).size() * sizeof(float);
  const std::size_t bytes = std::max(plan.bytes + more_bytes, picture), taken = resident_memory(),
                    left = available_memory();
  if (bytes <= taken || bytes - taken <= left) return;
  std::string advice = "a lower film.resolution, or rendering in parts with --crop,";
  if (method_of(scene.settings.method).needs_samples() && !plan.groups.empty())
    advice += " or a lower settings.max_samples";
  throw run_failed({},
                   fmt::format("out of memory: the image needs about {}, and {} are available; {} needs less",
                               short_bytes(bytes), short_bytes(left + taken), advice));
}

void check_precompute(const RenderArguments& arguments, const Scene& scene, const Plan& plan) {
  if (arguments.samples_ply.empty()) return;
  if (!method_of(scene.settings.method).needs_samples() || plan.groups.empty())
    throw bad_file(arguments.samples_ply, "no samples to write",
                   "settings.method \"hierarchical\", a translucent shape and a light");
}

struct Shading {
  RenderResult picture;
  std::optional<DirectResult> direct;  // without its image
  std::uint64_t rays = 0;
  double cpu_seconds = 0, embree_seconds = 0;
};

constexpr const char* kNothingKept = "no sums are stored; --resume FILE stores the sums of direct and volume";

/// Message about the stored sums after Ctrl-C.
std::string resume_hint(const RenderArguments& arguments, const Session& session,
                        const ResumableState& resumable) {
  if (arguments.resume.empty()) return kNothingKept;
  if (resumable.state.passes == 0)
    return "no sums are stored, because the first pass over the image is incomplete";
  const std::size_t samples = resumable.state.passes * entry_samples_per_pass(session.scene().film);
  return fmt::format("{1} stores the sums of {0} entry samples per pixel; resume with {2}", grouped(samples),
                     arguments.resume, arguments.command_line);
}

DirectResult shade_direct(const RenderArguments& arguments, Session& session, Monitor& monitor) {
  if (arguments.time_budget)
    return direct_within({session.scene(), session.world(), session.rays(), session.plan(), &monitor},
                         budget_left(arguments, session.scene()),
                         trial_writing(arguments, session.scene().film));
  if (!arguments.merged.files.empty()) {
    DirectState merged = merged_direct(arguments.merged, session);
    return render_direct({session.scene(), session.world(), session.rays(), session.plan(), &monitor},
                         merged);
  }
  ResumableState resumable(arguments, session.scene());
  try {
    DirectResult result =
        render_direct({session.scene(), session.world(), session.rays(), session.plan(), &monitor},
                      resumable.state, [&](const DirectState&) { resumable.keep_each_minute(); });
    resumable.keep();
    return result;
  } catch (const Error& stopped) {
    if (stopped.kind != ErrorKind::interrupted) throw;
    resumable.keep();
    throw Error(ErrorKind::interrupted, {}, 0, 0,
                "interrupted; " + resume_hint(arguments, session, resumable));
  }
}

/// Computes the inputs of the image. Ctrl-C saves random walks.
void prepare(StageRunner& stages, const RenderArguments& arguments, Session& session) {
  const auto run = [&] { stages.run_unmeasured("rays", [&] { session.prepare(&stages.monitor()); }); };
  if (session.scene().settings.method != Method::volume) return run();
  if (!arguments.merged.files.empty()) {
    const MergedWalks walks(arguments.merged, session);
    return run();
  }
  ResumableWalks walks(arguments.resume, session);
  try {
    run();
    walks.write();
  } catch (const Error& stopped) {
    if (stopped.kind != ErrorKind::interrupted) throw;
    walks.write();
    const std::string kept =
        arguments.resume.empty() ? kNothingKept
        : walks.passes() == 0
            ? "no sums are stored, because the first pass over the samples is incomplete"
            : fmt::format("{1} stores the sums of {0} passes of random walks; resume with {2}",
                          grouped(walks.passes()), arguments.resume, arguments.command_line);
    throw Error(ErrorKind::interrupted, {}, 0, 0, "interrupted; " + kept);
  }
}

SpentCameraRays camera_rays_of(const AdaptiveRays& adaptive, double until_error) {
  const std::uint64_t all = std::accumulate(adaptive.rays.begin(), adaptive.rays.end(), std::uint64_t(0));
  return {double(all) / double(adaptive.rays.size()), *std::ranges::max_element(adaptive.rays),
          adaptive.noise, adaptive.has_reached_most ? std::optional(until_error) : std::nullopt};
}

Summary summarize(const Session& session, const Shading& shading) {
  Summary summary;
  summary.peak_memory = peak_memory();
  summary.model_error = expected_model_error(session.plan());
  summary.leaves_out_reentry = std::ranges::any_of(
      session.plan().groups, [&](const BodyPlan& body) { return leaves_out_reentry(session.scene(), body); });
  summary.unknown_models = bodies_of_unknown_error(session.plan());
  summary.queries = shading.picture.queries;
  summary.estimated_error = settings_error(shading.picture);
  if (!shading.picture.adaptive.rays.empty())
    summary.camera_rays =
        camera_rays_of(shading.picture.adaptive, session.scene().settings.until_error.value_or(0));
  if (shading.direct) {
    summary.entry_samples = shading.direct->entry_samples;
    summary.direct_error = shading.direct->relative_error;
  }
  if (session.scene().film.denoise) summary.denoiser = denoiser_name();
  summary.rays = shading.rays;
  summary.shading_seconds = shading.cpu_seconds;
  summary.embree_seconds = shading.embree_seconds;
  const std::vector<Light> lights = recentred_lights(session.scene(), session.world());
  for (const Body& group : session.bodies()) {
    summary.samples += group.surface.samples.size();
    if (session.scene().settings.method == Method::volume) {
      const VolumeExitance& walked = volume_state(group).exitance.value;
      summary.walks = std::max(summary.walks, walked.walks);
      summary.walk_noise = std::max(summary.walk_noise, walked.relative_error);
    }
    std::map<std::string, double> noise;  // the largest of a light's channels
    for (std::size_t l = 0; l < group.transfers.size(); ++l) {
      double& largest = noise[lights[l].name];
      largest = std::max(largest, group.transfers[l].relative_error);
    }
    for (const auto& [light, error] : noise)
      if (error > 0) summary.noise.push_back({group.plan.name, light, error});
  }
  return summary;
}

/// The arguments with the settings chosen by --time-budget or --target-error.
RenderArguments repeating(const RenderArguments& arguments, const Session& session, const Shading& shading) {
  if (!chooses_settings(arguments)) return arguments;
  RenderArguments repeated = arguments;
  for (std::string& text : chosen_overrides(session, shading.direct ? shading.direct->entry_samples : 0)) {
    const std::string key = text.substr(0, text.find('=') + 1);
    std::erase_if(repeated.overrides, [&](const std::string& other) { return other.starts_with(key); });
    repeated.overrides.push_back(std::move(text));
  }
  if (arguments.target_error)
    repeated.overrides.push_back(
        fmt::format("settings.light_samples={}", session.scene().settings.light_samples));
  repeated.time_budget.reset();
  repeated.target_error.reset();
  return repeated;
}

/// State shared by all images of the command; null: none.
struct Shared {
  const StageCache* cache = nullptr;
  std::vector<std::string>* last_plan = nullptr;
};

/// error Error{bad_input}: an option without effect on the method
void check_method_options(const RenderArguments& arguments, const Scene& scene) {
  const Method method = scene.settings.method;
  if (arguments.part) check_part(*arguments.part, scene);
  const bool accumulates =
      !arguments.resume.empty() || arguments.part ||
      (method == Method::direct && (arguments.time_budget || scene.settings.until_error));
  if (accumulates && !scene.other_wavelengths.empty())
    throw Error(
        ErrorKind::bad_input, {}, 0, 0,
        "a spectral image of more than three wavelengths has no sums to continue, and cannot stop at an "
        "error or a time",
        "--set film.wavelengths=3, or --entry-samples N",
        fmt::format("{} wavelengths", 3 * (1 + scene.other_wavelengths.size())));
  if (method == Method::direct || scene.lights.empty()) return;
  const auto no_use = [&](const char* option, const char* methods) {
    return Error(ErrorKind::bad_input, {}, 0, 0, std::string(option) + " has no effect with this method",
                 std::string("--method ") + methods, std::string(name_of(method)));
  };
  if (arguments.gives_entry_samples) throw no_use("--entry-samples", "direct");
  if (method == Method::volume) return;
  if (arguments.time_budget && scene.settings.until_error)
    throw Error(ErrorKind::bad_input, {}, 0, 0, "--time-budget chooses settings for the camera rays of --spp",
                "one of --time-budget and --until-error");
  if (!arguments.resume.empty())
    throw bad_file(arguments.resume, "this method has no sums to resume", "--method direct or volume");
}

/// error Error{run_failed}: no denoiser; Error{bad_input}: the sum of light groups is not a denoised image
void check_denoising(const RenderArguments& arguments, const Scene& scene) {
  if (!scene.film.denoise) return;
  if (is_named(arguments.layers, kLightGroups))
    throw Error(ErrorKind::bad_input, {}, 0, 0, "light groups do not sum to a denoised image",
                "--layers light_groups, or --denoise");
  denoiser_name();
}

bool holds_view(const RenderArguments& arguments, bool is_frame) {
  return is_frame || is_named(arguments.layers, kLightGroups);
}

std::size_t bytes_of_view(const Session& session) {
  const Scene& scene = session.scene();
  const std::vector<Light> lights = recentred_lights(scene, session.world());
  return held_view_bytes(scene.film, lights.size(), seen_pixels(scene, lights, session.world()));
}

/// Gives the session its scene and returns the scene's hash; none if the frame exists already.
std::optional<std::string> load(StageRunner& stages, const RenderArguments& arguments, Session& session,
                                std::optional<int> frame) {
  return stages.run("loading", [&]() -> std::optional<std::string> {
    Scene scene = load_scene(arguments.scene, arguments.overrides, frame.value_or(1));
    std::string hash = frame ? frame_hash(arguments.scene, arguments.overrides, scene)
                             : scene_hash(arguments.scene, arguments.overrides, scene);
    if (frame && is_rendered(arguments, hash, *frame)) return std::nullopt;
    if (!arguments.merged.files.empty() && hash != arguments.merged.hash)
      throw bad_file(arguments.scene, "differs from the scene of the parts, or its files do",
                     "the files of opaline render --part");
    if (frame) session.expect_pictures(scene.camera_frames);
    session.hold_view(holds_view(arguments, frame.has_value()));
    session.edit(std::move(scene));
    return hash;
  });
}

/// CPU time of the first trial of --target-error, s.
double seconds_of_trial(const Session& session) {
  Scene trial = session.scene();
  if (trial.settings.method != Method::hierarchical) trial.settings.cell_size = kWidestCell;
  return expected_seconds(trial, make_plan(trial, session.world()));
}

/// Chooses open settings, and prints the plan.
/// error Error{bad_input}: options are incompatible, or exceed the memory
KnownErrors plan(StageRunner& stages, const RenderArguments& arguments, Session& session,
                 const Shared& shared, bool is_frame) {
  const Scene& scene = session.scene();
  name_method(arguments, session);
  check_outputs_are_no_inputs(arguments, scene);
  check_method_options(arguments, scene);
  check_denoising(arguments, scene);
  check_layers(arguments.layers, scene);
  check_precompute(arguments, scene, session.plan());
  const std::size_t more_bytes = arguments.part
                                     ? part_bytes(*arguments.part, session)
                                     : asked_layer_bytes(arguments.layers, scene) +
                                           (has_adaptive_rays(scene)          ? adaptive_bytes(scene.film)
                                            : holds_view(arguments, is_frame) ? bytes_of_view(session)
                                                                              : 0);
  check_memory(scene, session.plan(), more_bytes);
  if (arguments.target_error) print_trial(arguments.log, seconds_of_trial(session));
  KnownErrors errors = choose_settings(stages, arguments, session);
  if (shared.last_plan->empty()) {
    warn_of_unlit_options(arguments, scene);
    warn_of_unused_media(arguments.log, arguments.overrides, scene);
  }
  print_plan(arguments.log, scene, session.world(), announced_plan(arguments, session, more_bytes),
             shared.last_plan);
  check_memory(scene, session.plan(), more_bytes);  // with the chosen settings
  return errors;
}

void print_picture_warnings(const RenderArguments& arguments, const Session& session,
                            const Shading& shading) {
  if (shading.picture.non_finite > 0)
    print_warning(arguments.log,
                  std::to_string(shading.picture.non_finite) +
                      " pixels are not finite; 0 is written instead; please report this defect");
  for (const std::string& text : picture_warnings(session.scene(), session.world(), shading.picture.image))
    print_warning(arguments.log, text);
  for (const std::string& text : model_warnings(session.plan())) print_warning(arguments.log, text);
  for (const std::string& text : placement_warnings(session.scene(), session.world(), session.plan()))
    print_warning(arguments.log, text);
  for (const std::string& text :
       warnings_of_shapes_inside(session.scene(), session.world(), session.rays(), session.plan()))
    print_warning(arguments.log, text);
}

/// The image without its metadata, with its warnings.
Shading make_picture(StageRunner& stages, const RenderArguments& arguments, Session& session,
                     const Shared& shared, bool is_frame) {
  const std::size_t noted = session.costs().size();
  prepare(stages, arguments, session);
  for (std::size_t i = noted; i < session.costs().size(); ++i) stages.note(session.costs()[i]);
  if (shared.cache != nullptr || is_frame)
    print_decisions(arguments.log, session.decisions(),
                    shared.cache != nullptr ? shared.cache->warning() : "");
  for (const Body& body : session.bodies())
    for (const std::string& text : method_of(body.plan.method).warnings(body, session.world().unit))
      print_warning(arguments.log, text);
  Shading shading;
  const RayScene::Statistics before = session.rays().statistics();
  shading.picture = stages.run("shading", [&] {
    const Scene& scene = session.scene();
    if (scene.settings.method != Method::direct || !scene.other_wavelengths.empty())
      return session.render(&stages.monitor());
    shading.direct = shade_direct(arguments, session, stages.monitor());
    if (scene.wavelengths) {
      Image& image = shading.direct->picture.image;
      WavelengthLayers layers;
      if (is_named(arguments.layers, kWavelengths)) layers.keep(image, *scene.wavelengths);
      convert_to_rgb(image, scene.wavelengths->to_rgb);
      layers.append(image);
    }
    RenderResult& picture = shading.direct->picture;
    if (scene.film.denoise) denoise(picture.image, picture.translucent, &stages.monitor());
    return std::move(picture);
  });
  const RayScene::Statistics after = session.rays().statistics();
  shading.rays = after.rays - before.rays;
  shading.embree_seconds = after.seconds - before.seconds;
  shading.cpu_seconds = stages.costs().back().cpu_seconds;
  print_picture_warnings(arguments, session, shading);
  return shading;
}

/// Writes the outputs, and prints their names and the costs.
void finish(StageRunner& stages, const RenderArguments& arguments, const RenderArguments& repeated,
            const Session& session, const Shading& shading, const KnownErrors& errors) {
  auto outputs =
      stages.run("writing", [&] { return write_outputs(arguments, session, shading.picture.image); });
  Summary summary = summarize(session, shading);
  if (arguments.time_budget) {
    double spent = 0;
    for (const StageCost& cost : stages.costs()) spent += cost.stage == "verifying" ? 0 : cost.cpu_seconds;
    summary.budget = {*arguments.time_budget, spent};
    warn_of_little_time(arguments, session.scene().film, spent, shading.direct);
  }
  if (chooses_settings(arguments)) summary.repeat_command = command_again(repeated);
  summary.costs = stages.costs();
  summary.errors = errors;
  summary.outputs = std::move(outputs);
  print_summary(arguments.log, summary);
}

/// Renders one image; returns false if it existed. frame: of a range, with an anchored session.
bool render_scene(const RenderArguments& arguments, Session& session, const Shared& shared,
                  std::optional<int> frame) {
  StageRunner stages(arguments.log);
  if (arguments.time_budget) stages.note({"start", 0, process_cpu_seconds(), 0, peak_memory()});
  std::optional<std::string> hash = load(stages, arguments, session, frame);
  if (!hash) {
    print_outputs(arguments.log, "skipped", arguments.outputs);
    return false;
  }
  const Scene& scene = session.scene();
  KnownErrors errors = plan(stages, arguments, session, shared, frame.has_value());
  if (arguments.part) {
    const bool is_new = render_part(stages, arguments, session, *hash, frame);
    print_outputs(arguments.log, is_new ? "wrote" : "skipped", arguments.outputs);
    return is_new;
  }
  Shading shading = make_picture(stages, arguments, session, shared, frame.has_value());
  std::optional<Error> stopped;  // by Ctrl-C during the error measurement; the image is complete
  try {
    errors.measured = verify_picture(stages, arguments, session, errors, shading.picture);
  } catch (const Error& failure) {
    if (failure.kind != ErrorKind::interrupted) throw;
    stopped = failure;
    stages.monitor().cancelled = false;
  }
  const RenderArguments repeated = repeating(arguments, session, shading);
  if (arguments.time_budget) hash = scene_hash(repeated.scene, repeated.overrides, scene);
  Image& image = shading.picture.image;
  // The image depends on the target of --target-error, but on the clock with --time-budget.
  image.metadata = make_metadata(arguments.time_budget ? repeated : arguments, *hash, scene, session.world(),
                                 session.bodies(), frame);
  if (errors.target || errors.measured)
    image.metadata.emplace_back("opaline:error", compact(errors_json(errors)));
  add_asked_layers(stages, arguments.layers, session, image);
  if (arguments.timings_in_metadata) image.metadata.push_back(timings_metadata(stages.costs()));
  finish(stages, arguments, repeated, session, shading, errors);
  if (stopped) throw *stopped;
  return true;
}

}  // namespace

void render_command(RenderArguments arguments) {
  const std::vector<std::string> outputs = arguments.outputs;
  const std::optional<Movie> movie = Movie::take(arguments);
  std::signal(SIGPIPE, SIG_IGN);  // a closed log pipe must not fail the render
  std::optional<tbb::global_control> threads;
  if (arguments.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(arguments.threads));
  std::optional<StageCache> cache;
  if (!arguments.cache.empty()) cache.emplace(arguments.cache, arguments.cache_bytes);
  Session session(cache ? &*cache : nullptr);
  session.keep_wavelengths(is_named(arguments.layers, kWavelengths));
  session.expect_edits(!arguments.frames.empty() || is_named(arguments.layers, kLightGroups));
  if (arguments.frames.empty())
    check_writable(arguments);
  else
    for (const int frame : arguments.frames) check_writable(arguments_of_frame(arguments, frame));
  std::vector<std::string> last_plan;
  const Shared shared{cache ? &*cache : nullptr, &last_plan};
  if (arguments.frames.empty()) {
    render_scene(arguments, session, shared, {});
    return;
  }
  RenderArguments settled =
      arguments.target_error ? settled_for_frames(arguments, cache ? &*cache : nullptr) : arguments;
  if (arguments.target_error) {
    RenderArguments repeated = settled;
    repeated.outputs = outputs;
    const std::string rate =
        arguments.frames_per_second ? fmt::format(" --fps {}", *arguments.frames_per_second) : "";
    print_repeat_command(arguments.log,
                         command_again(repeated) + rate + " --frames " + frames_text(arguments.frames));
  }
  anchor_session(session, settled.scene, settled.overrides);
  FramesSoFar so_far;
  settled.log.frames = &so_far;
  for_frames(settled.log, settled.frames, so_far, [&](int frame) {
    return render_scene(arguments_of_frame(settled, frame), session, shared, frame);
  });
  if (!movie) return;
  movie->encode(arguments.frames, arguments.frames_per_second.value_or(24));
  print_outputs(arguments.log, "wrote", {movie->path()});
}
}  // namespace opaline
