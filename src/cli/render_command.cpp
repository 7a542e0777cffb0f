// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/global_control.h>

#include <chrono>
#include <csignal>
#include <optional>

#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/metadata.h"
#include "cli/quality.h"
#include "cli/report.h"
#include "cli/stages.h"
#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"
#include "opaline/render/direct.h"
#include "opaline/scene/load_scene.h"
#include "opaline/session/session.h"

namespace opaline {
namespace {

/// What cannot be written at the end is said before the work.
void check_writable(const RenderArguments& arguments) {
  for (const std::string& path : arguments.outputs) const AtomicFile probe(path);
  if (!arguments.samples_ply.empty()) const AtomicFile probe(arguments.samples_ply);
  if (!arguments.resume.empty()) const AtomicFile probe(arguments.resume);
}

void check_precompute(const RenderArguments& arguments, const Scene& scene, const Plan& plan) {
  if (arguments.samples_ply.empty()) return;
  if (scene.settings.method != Method::hierarchical || plan.groups.empty())
    throw bad_file(arguments.samples_ply, "there are no samples to write",
                   "settings.method \"hierarchical\" and a translucent shape");
}

/// Writes everything that was asked for; returns the names.
std::vector<std::string> write_outputs(const RenderArguments& arguments, const Session& session,
                                       const Image& image) {
  std::size_t cut = 0;
  std::vector<std::string> written;
  for (const std::string& path : arguments.outputs) {
    if (output_format(path) == OutputFormat::exr)
      cut = write_exr(path, image, session.scene().film.half).half_overflow;
    else
      write_png(path, image, session.scene().film.exposure);
    written.push_back(path);
  }
  if (!arguments.samples_ply.empty()) {
    write_samples_ply(arguments.samples_ply, session.groups(), session.world());
    written.push_back(arguments.samples_ply);
  }
  if (cut > 0)
    print_warning(arguments.log, std::to_string(cut) +
                                     " values above 65504 do not fit 16 bits and were cut; "
                                     "--set film.pixel_type=float keeps them");
  return written;
}

struct Shading {
  RenderResult picture;
  std::optional<DirectResult> direct;  // without its picture
  std::uint64_t rays = 0;
  double cpu_seconds = 0, embree_seconds = 0;
};

/// Sums that are kept in the --resume file, if there is one.
class ResumableState {
 public:
  ResumableState(const RenderArguments& arguments, const Scene& scene)
      : path_(arguments.resume), scene_(scene) {
    if (path_.empty()) return;
    key_ = direct_scene_key(arguments, scene_);
    state = read_direct_state(path_, scene_, key_);
    written_ = state.passes;
  }

  void keep_each_minute() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::minutes(1)) return;
    keep();
    last_ = now;
  }

  void keep() {
    if (path_.empty() || state.passes == written_) return;
    write_direct_state(path_, state, scene_, key_);
    written_ = state.passes;
  }

  DirectState state;

 private:
  std::string path_, key_;
  const Scene& scene_;
  std::size_t written_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

DirectResult shade_direct(const RenderArguments& arguments, const Session& session, Monitor& monitor) {
  ResumableState resumable(arguments, session.scene());
  try {
    DirectResult result = render_direct({session.scene(), session.world(), session.rays(), session.plan(),
                                         &monitor, [&](const DirectState&) { resumable.keep_each_minute(); }},
                                        resumable.state);
    resumable.keep();
    return result;
  } catch (const Error& stopped) {
    if (stopped.kind == ErrorKind::interrupted) resumable.keep();
    throw;
  }
}

Shading shade(StageRunner& stages, const RenderArguments& arguments, Session& session) {
  Shading shading;
  const RayScene::Statistics before = session.rays().statistics();
  shading.picture = stages.run("shading", [&] {
    if (session.scene().settings.method == Method::direct) {
      shading.direct = shade_direct(arguments, session, stages.monitor());
      return std::move(shading.direct->picture);
    }
    return session.render(&stages.monitor());
  });
  const RayScene::Statistics after = session.rays().statistics();
  shading.rays = after.rays - before.rays;
  shading.embree_seconds = after.seconds - before.seconds;
  shading.cpu_seconds = stages.costs().back().cpu_seconds;
  return shading;
}

Summary summarize(const Session& session, const Shading& shading) {
  Summary summary;
  summary.peak_memory = peak_memory();
  summary.queries = shading.picture.queries;
  summary.estimated_error = estimated_relative_error(shading.picture.image);
  if (shading.direct) {
    summary.entry_samples = shading.direct->entry_samples;
    summary.direct_error = shading.direct->relative_error;
  }
  summary.rays = shading.rays;
  summary.shading_seconds = shading.cpu_seconds;
  summary.embree_seconds = shading.embree_seconds;
  for (const TranslucentGroup& group : session.groups()) {
    summary.samples += group.surface.samples.size();
    for (std::size_t l = 0; l < group.transfers.size(); ++l)
      if (group.transfers[l].relative_error > 0)
        summary.noise.push_back(
            {group.plan.name, session.scene().lights[l].name, group.transfers[l].relative_error});
  }
  return summary;
}

/// One picture; `frame`: of a range, whose session is anchored.
void render_scene(const RenderArguments& arguments, Session& session, const StageCache* cache,
                  std::optional<int> frame) {
  StageRunner stages(arguments.log);
  bool is_there = false;
  const std::string hash = stages.run("loading", [&] {
    Scene scene = load_scene(arguments.scene, arguments.overrides, frame.value_or(1));
    std::string bytes_hash = frame ? frame_hash(arguments.scene, arguments.overrides, scene)
                                   : scene_hash(arguments.scene, arguments.overrides, scene);
    is_there = frame && is_rendered(arguments, bytes_hash, *frame);
    if (!is_there) session.edit(std::move(scene));
    return bytes_hash;
  });
  if (is_there) return print_skipped(arguments.log, arguments.outputs);
  const Scene& scene = session.scene();
  if (!arguments.resume.empty() && scene.settings.method != Method::direct)
    throw bad_file(arguments.resume, "there are no sums to go on from", "--method direct");
  check_precompute(arguments, scene, session.plan());
  KnownErrors errors{arguments.target_error, choose_settings(stages, arguments, session), {}};
  print_plan(arguments.log, scene, session.plan());

  stages.run_unmeasured("rays", [&] { session.prepare(&stages.monitor()); });
  for (const StageCost& cost : session.costs()) stages.note(cost);
  if (cache != nullptr || frame)
    print_decisions(arguments.log, session.decisions(), cache != nullptr ? cache->warning() : "");
  Shading shading = shade(stages, arguments, session);
  if (shading.picture.non_finite > 0)
    print_warning(arguments.log, std::to_string(shading.picture.non_finite) +
                                     " pixels are not finite and were written as 0; this is a defect");
  Image& image = shading.picture.image;
  errors.measured = verify_picture(stages, arguments, session, errors.chosen, image);
  image.metadata = make_metadata(arguments, hash, scene, session.groups(), frame);
  if (errors.target || errors.measured)
    image.metadata.emplace_back("opaline:error", compact(errors_json(errors)));
  if (arguments.timings_in_metadata) image.metadata.push_back(timings_metadata(stages.costs()));

  auto outputs = stages.run("writing", [&] { return write_outputs(arguments, session, image); });
  Summary summary = summarize(session, shading);
  summary.costs = stages.costs();
  summary.errors = errors;
  summary.outputs = std::move(outputs);
  print_summary(arguments.log, summary);
}

}  // namespace

void render_command(const RenderArguments& arguments) {
  std::signal(SIGPIPE, SIG_IGN);  // a reader of the log that leaves must not cost the picture
  std::optional<tbb::global_control> threads;
  if (arguments.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(arguments.threads));
  std::optional<StageCache> cache;
  if (!arguments.cache.empty()) cache.emplace(arguments.cache, arguments.cache_bytes);
  Session session(cache ? &*cache : nullptr);
  const auto render_one = [&](const RenderArguments& own, std::optional<int> frame) {
    render_scene(own, session, cache ? &*cache : nullptr, frame);
  };
  if (arguments.frames.empty()) {
    check_writable(arguments);
    return render_one(arguments, {});
  }
  for (const int frame : arguments.frames) check_writable(arguments_of_frame(arguments, frame));
  anchor_session(session, arguments.scene, arguments.overrides);
  for_frames(arguments.log, arguments.frames,
             [&](int frame) { render_one(arguments_of_frame(arguments, frame), frame); });
}

}  // namespace opaline
