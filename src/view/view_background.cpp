// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_background.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "methods/volume/volume_state.h"
#include "opaline/error.h"

namespace opaline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kRest{400};  // pause after the last edit
constexpr double kBetween = 1.5;                 // s of work between two images of a reference
constexpr std::size_t kMostEntries = 1 << 16;    // then a reference is done
constexpr double kFirstNoise = 1, kLessNoise = .8, kLeastNoise = .005;  // relative noise of random walks

/// The scene without settings varied by the trade-off, and without values not affecting errors.
Scene without_trade(Scene scene) {
  scene.settings.method = Method::hierarchical;
  scene.settings.samples.reset();
  scene.settings.sample_spacing.reset();
  scene.settings.tolerance = 0;
  scene.film.exposure = 0;
  scene.film.view = {};
  return scene;
}

/// True if the scene has the point's settings; compares lengths after conversion to the scene's unit and
/// back.
bool is_at(const Settings& settings, const TradePoint& point) {
  const auto is_near = [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::abs(b); };
  if (settings.method != point.method) return false;
  if (point.method == Method::lambert) return true;
  return settings.samples == point.samples &&
         (point.samples ||
          (settings.sample_spacing && is_near(*settings.sample_spacing, *point.sample_spacing))) &&
         is_near(settings.tolerance, point.tolerance);
}

Layer squared(Layer layer) {
  for (std::vector<float>& channel : layer.channels)
    for (float& value : channel) value *= value;
  return layer;
}

}  // namespace

ViewBackground::ViewBackground(BackgroundEvents events)
    : events_(std::move(events)), thread_([this] { run(); }) {}

ViewBackground::~ViewBackground() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    monitor_.cancelled = true;
  }
  news_.notify_one();
}

void ViewBackground::ask(const BackgroundWork& work) {
  {
    const std::lock_guard lock(mutex_);
    if (asked_ == work) return;
    asked_ = work;
    changed_ = true;
    monitor_.cancelled = true;
  }
  news_.notify_one();
}

void ViewBackground::start(Scene scene, std::shared_ptr<const ViewPicture> final_picture) {
  {
    const std::lock_guard lock(mutex_);
    job_ = Job{std::move(scene), std::move(final_picture)};
    changed_ = true;
    monitor_.cancelled = true;
  }
  news_.notify_one();
}

void ViewBackground::stop() {
  const std::lock_guard lock(mutex_);
  job_.reset();
  monitor_.cancelled = true;
}

void ViewBackground::run() {
  while (true) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [&] { return stopped_ || changed_; });
    // A newer change within the pause restarts it.
    while (!stopped_ && std::exchange(changed_, false))
      news_.wait_for(lock, kRest, [&] { return stopped_ || changed_; });
    if (stopped_) return;
    const BackgroundWork wanted = asked_;
    const std::optional<Job> job = job_;
    if (job) monitor_.cancelled = false;
    lock.unlock();
    if (wanted == BackgroundWork{}) {
      session_.reset();
      trade_scene_.reset();
      points_.clear();
      direct_ = {};
      direct_revision_ = 0;
    }
    if (!job) continue;
    try {
      work(*job, wanted);
    } catch (const Error& failure) {
      if (failure.kind != ErrorKind::interrupted) events_.failed(job->shown->revision, failure.what());
    } catch (const std::exception& failure) {
      session_.reset();
      events_.failed(job->shown->revision, failure.what());
    }
  }
}

void ViewBackground::work(const Job& job, const BackgroundWork& wanted) {
  if (wanted == BackgroundWork{}) return;
  if (session_ == nullptr) session_ = std::make_unique<Session>();
  if (wanted.target_error) return choose(job, *wanted.target_error);  // the rest follows with its final image
  if (wanted.trade) find_trade(job);
  if (wanted.reference == Method::direct) refine_direct(job);
  if (wanted.reference == Method::volume) refine_volume(job);
}

void ViewBackground::choose(const Job& job, double target_error) {
  session_->edit(job.scene);
  const Scene scene = with_named_method(*session_);
  const Settings& settings = scene.settings;
  const bool is_volume = settings.method == Method::volume_diffusion || settings.method == Method::automatic;
  if (!is_volume && (settings.method != Method::hierarchical || settings.evaluator == EvaluatorKind::classic))
    throw Error(ErrorKind::bad_input, {}, 0, 0,
                "a target error requires hierarchical evaluation or volume_diffusion",
                "the method volume_diffusion, or hierarchical with an evaluator other than classic");
  const auto reach = is_volume ? reach_volume_error : reach_error;
  ChosenSettings chosen{job.shown->revision, reach(*session_, scene, target_error, &monitor_), {}};
  chosen.overrides = chosen_overrides(*session_);
  chosen.overrides.push_back(
      fmt::format("settings.light_samples={}", session_->scene().settings.light_samples));
  events_.chosen(chosen);
}

// ---- the trade ----------------------------------------------------------------------------------------------

/// True if the points belong to the scene: after choosing one of them, or after undo.
bool ViewBackground::keeps_trade(const Job& job) const {
  if (!trade_scene_ || without_trade(*trade_scene_) != without_trade(job.scene)) return false;
  return trade_scene_->settings == job.scene.settings ||
         std::ranges::any_of(points_, [&](const TradePoint& p) { return is_at(job.scene.settings, p); });
}

void ViewBackground::tell_trade(const Job& job, bool is_whole) {
  TradeState state{job.shown->revision, job.scene.mm_per_unit, points_, {}, is_whole};
  const bool is_given = !trade_scene_ || trade_scene_->settings == job.scene.settings;
  for (std::size_t i = 0; i < points_.size() && !state.now; ++i)
    if (is_at(job.scene.settings, points_[i]) ||
        (is_given && points_[i].is_given && job.scene.settings.method == Method::hierarchical))
      state.now = i;
  events_.trade(state);
}

void ViewBackground::find_trade(const Job& job) {
  if (keeps_trade(job)) return tell_trade(job, true);
  trade_scene_.reset();
  points_.clear();
  tell_trade(job, false);
  try_trade(
      *session_, job.scene,
      [&](const TradePoint& point) {
        advance(&monitor_, 0);
        points_.push_back(point);
        tell_trade(job, false);
      },
      &monitor_);
  trade_scene_ = job.scene;
  tell_trade(job, true);
}

// ---- references ---------------------------------------------------------------------------------------------

void ViewBackground::publish(const Job& job, RenderResult result, const Layer& variance,
                             ReferenceState state) {
  advance(&monitor_, 0);  // obsolete once there is a newer scene
  state.revision = job.shown->revision;
  const Layer shown = extract_layer(job.shown->image, "diffuse");
  const Layer reference = extract_layer(result.image, "diffuse");
  const std::vector<std::uint8_t>& translucent = job.shown->translucent;
  state.difference = error_beyond_noise(shown, reference, variance,
                                        translucent.empty() ? object_pixels(job.shown->image) : translucent);
  events_.reference(std::make_shared<const ViewPicture>(
                        ViewPicture{state.revision, PictureStep::reference, 0, std::move(result.image), {}}),
                    state);
}

void ViewBackground::refine_direct(const Job& job) {
  Scene scene = job.scene;
  scene.settings.method = Method::direct;
  scene.settings.until_error.reset();
  ++scene.settings.seed;  // independent of an image by `direct`
  session_->edit(scene);
  check_memory(session_->plan());
  session_->prepare(&monitor_);
  scene = session_->scene();
  const std::size_t each = entry_samples_per_pass(scene.film);
  if (std::exchange(direct_revision_, job.shown->revision) != job.shown->revision) direct_ = {};
  DirectState& state = direct_;
  for (std::size_t passes = state.passes + 2;;) {
    scene.settings.entry_samples = passes * each;
    const Clock::time_point start = Clock::now();
    const std::size_t before = state.passes;
    DirectResult result =
        render_direct({scene, session_->world(), session_->rays(), session_->plan(), &monitor_}, state);
    const double a_pass =
        std::chrono::duration<double>(Clock::now() - start).count() / double(state.passes - before);
    const Layer variance = extract_layer(result.picture.image, "variance");
    publish(job, std::move(result.picture), variance,
            {0, Method::direct, result.entry_samples, result.relative_error, 0});
    if (result.entry_samples >= kMostEntries) return;
    passes += std::clamp<std::size_t>(std::size_t(kBetween / a_pass), 1, passes);
  }
}

void ViewBackground::refine_volume(const Job& job) {
  Scene scene = job.scene;
  scene.settings.method = Method::volume;
  ++scene.settings.seed;
  double before = INFINITY;
  for (double until = kFirstNoise;;) {
    scene.settings.until_error = until;
    session_->edit(scene);
    check_memory(session_->plan());
    session_->prepare(&monitor_);
    RenderResult result = session_->render(&monitor_);
    ReferenceState state{0, Method::volume, 0, 0, 0};
    for (const Body& body : session_->bodies()) {
      const VolumeExitance& walked = volume_state(body).exitance.value;
      state.samples = std::max(state.samples, walked.walks);
      state.noise = std::max(state.noise, walked.relative_error);
    }
    const Layer variance = squared(extract_layer(result.image, "error"));
    publish(job, std::move(result), variance, state);
    if (state.noise <= kLeastNoise || state.noise >= before) return;
    before = state.noise;
    until = kLessNoise * std::min(until, state.noise);
  }
}

}  // namespace opaline
