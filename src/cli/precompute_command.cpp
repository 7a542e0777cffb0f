// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/global_control.h>

#include <optional>

#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/stages.h"
#include "input/load_scene.h"

namespace opaline {
namespace {

void precompute_frame(const PrecomputeArguments& arguments, Session& session, StageCache& cache,
                      std::optional<int> frame) {
  StageRunner stages(arguments.log);
  stages.run("loading", [&] {
    Scene scene = load_scene(arguments.scene, arguments.overrides, frame.value_or(1));
    if (frame) session.expect_pictures(scene.camera_frames);
    const Method method = scene.settings.method;  // stages of others are cheap, or have no entries in a cache
    if (method != Method::automatic && method != Method::volume_diffusion)
      scene.settings.method = Method::hierarchical;
    session.edit(std::move(scene));
    return 0;
  });
  stages.run_unmeasured("rays", [&] { session.prepare(&stages.monitor()); });
  for (const StageCost& cost : session.costs()) stages.note(cost);
  print_decisions(arguments.log, session.decisions(), cache.warning());
}

}  // namespace

void precompute_command(const PrecomputeArguments& arguments) {
  std::optional<tbb::global_control> threads;
  if (arguments.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(arguments.threads));
  StageCache cache(arguments.cache, arguments.cache_bytes);
  Session session(&cache);
  session.expect_edits(!arguments.frames.empty());
  if (arguments.frames.empty()) return precompute_frame(arguments, session, cache, {});
  anchor_session(session, arguments.scene, arguments.overrides);
  FramesSoFar so_far;
  PrecomputeArguments range = arguments;
  range.log.frames = &so_far;
  for_frames(range.log, range.frames, so_far, [&](int frame) {
    precompute_frame(range, session, cache, frame);
    return true;
  });
}

}  // namespace opaline
