// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/machine_memory.h"
#include "core/stopwatch.h"
#include "core/units.h"
#include "methods/direct/direct.h"
#include "opaline/error.h"
#include "plan/expected_error.h"
#include "plan/expected_seconds.h"
#include "plan/picture_warnings.h"
#include "plan/placement_warnings.h"
#include "plan/shapes_inside.h"
#include "render/adaptive_rays.h"
#include "render/camera_rays.h"
#include "render/fields/make_fields.h"
#include "session/spectral_image.h"
#include "subsurface/method.h"
#include "view/lit_anew.h"

namespace opaline {
namespace {

constexpr double kFrame = 1.0 / 30, kDraft = .022;  // s: an interactive image, its rays
constexpr double kKnob = .06;                       // s: an image after turning a knob
constexpr double kPatience = .5;                    // s: maximum wait for running interactive work
constexpr double kLongFinal = .25;                  // s: longer final images get sharper ones before
// A change with more than this ratio to the last one's expected time, and this time, needs other stages.
constexpr double kDearer = 2, kSlow = .1;  // s
constexpr int kCoarsest = 16;

std::unique_ptr<Session> new_session() {
  auto session = std::make_unique<Session>();
  session->hold_view(true);
  session->match_new_session(true);
  return session;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The same view in fewer pixels, with one ray each.
Film coarse_film(Film film, int stride) {
  for (int& side : film.resolution) side = (side + stride - 1) / stride;
  if (film.crop) {
    std::array<int, 4>& crop = *film.crop;
    for (std::size_t i = 0; i < 2; ++i) {
      crop[i] = std::min(crop[i] / stride, film.resolution[i] - 1);
      crop[i + 2] = std::clamp((crop[i + 2] + stride - 1) / stride, crop[i] + 1, film.resolution[i]);
    }
  }
  film.samples_per_pixel = 1;
  return film;
}

double pixels_of(const Film& film) {
  const Rectangle part = rendered_part(film);
  return double(part.x1 - part.x0) * double(part.y1 - part.y0);
}

}  // namespace

void check_memory(const Plan& plan) {
  const std::size_t taken = resident_memory(), left = available_memory();
  if (plan.bytes > taken && plan.bytes - taken > left)
    throw run_failed({}, "out of memory: the image needs about " + short_bytes(plan.bytes) +
                             "; available: " + short_bytes(left + taken));
}

ViewRenderer::ViewRenderer(ViewEvents events)
    : events_(std::move(events)), session_(new_session()), thread_([this] { run(); }) {}

ViewRenderer::~ViewRenderer() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    monitor_.cancelled = brief_.cancelled = true;
  }
  changed_.notify_one();
}

void ViewRenderer::show(Scene scene, std::uint32_t revision, std::optional<Scene> reference,
                        bool has_new_files) {
  // The live image has the camera rays of the film.
  if (has_adaptive_rays(scene)) scene.settings.until_error.reset();
  if (reference && has_adaptive_rays(*reference)) reference->settings.until_error.reset();
  {
    const std::lock_guard lock(mutex_);
    has_new_files = has_new_files || (wanted_ && wanted_->has_new_files);
    wanted_ = Wanted{std::move(scene), std::move(reference), revision, Clock::now(), has_new_files};
    monitor_.cancelled = true;
  }
  changed_.notify_one();
}

void ViewRenderer::pick(int x, int y) {
  {
    const std::lock_guard lock(mutex_);
    picked_ = {x, y};
  }
  changed_.notify_one();
}

std::optional<std::size_t> ViewRenderer::shape_at(const std::array<int, 2>& pixel) const {
  if (!prepared_) return {};
  const CameraRays camera_rays(prepared_->camera, prepared_->film, session_->world());
  std::vector<TracedRay> rays{{camera_rays.middle_ray(pixel[0], pixel[1]), {}}};
  intersect_from_camera(session_->scene(), session_->rays(), rays);
  const Hit& hit = rays.front().hit;
  return hit.mesh == Hit::kMiss ? std::nullopt : std::optional<std::size_t>(hit.mesh);
}

std::optional<ViewRenderer::Wanted> ViewRenderer::next() {
  std::unique_lock lock(mutex_);
  monitor_.begin(nullptr, 0);
  monitor_.show_partial = {};
  draft_.reset();
  is_drawing_ = refines_ = false;
  for (;;) {
    changed_.wait(lock, [&] { return stopped_ || wanted_ || picked_; });
    if (stopped_) return {};
    if (!picked_) break;
    const std::array<int, 2> pixel = *std::exchange(picked_, {});
    lock.unlock();
    try {
      events_.picked(shape_at(pixel));
    } catch (const std::bad_alloc&) {  // no answer
    }
    lock.lock();
  }
  is_drawing_ = true;
  drawing_since_ = Clock::now();
  monitor_.cancelled = brief_.cancelled = false;
  return std::exchange(wanted_, {});
}

bool ViewRenderer::is_drawing() {
  const std::lock_guard lock(mutex_);
  return is_drawing_ || wanted_;
}

void ViewRenderer::end_stale_work() {
  const std::lock_guard lock(mutex_);
  if (wanted_ && seconds_since(drawing_since_) > kPatience) brief_.cancelled = true;
}

void ViewRenderer::run() {
  while (const std::optional<Wanted> wanted = next()) {
    try {
      draw(*wanted);
    } catch (const Error& failure) {
      if (failure.kind != ErrorKind::interrupted) events_.failed(wanted->revision, failure.what());
    } catch (const std::exception& failure) {
      restart();
      events_.failed(wanted->revision, dynamic_cast<const std::bad_alloc*>(&failure) != nullptr
                                           ? "out of memory"
                                           : failure.what());
    }
  }
}

void ViewRenderer::restart() {
  session_ = new_session();
  prepared_.reset();
  anchor_.reset();
  final_.reset();
}

/// Frames share samples, as in `opaline render --frames`, and thereby all results equal between them. Changed
/// samples need a new session, because anchoring is permanent.
void ViewRenderer::anchor(const Wanted& wanted) {
  Scene reference = *wanted.reference;
  reference.camera = {};
  reference.lights.clear();
  if (anchor_ != reference) {
    anchor_.reset();
    prepared_.reset();
    session_ = new_session();
    session_->match_new_session(false);
    session_->anchor(*wanted.reference, &brief_);
    anchor_ = std::move(reference);
  }
  session_->expect_pictures(wanted.scene.camera_frames);
}

void ViewRenderer::draw(const Wanted& wanted) {
  if (wanted.has_new_files) {  // the session notices, but an image of before must not be relit
    prepared_.reset();
    final_.reset();
  }
  if (wanted.reference) anchor(wanted);
  Change change = anything;
  if (prepared_) {
    Scene before = std::move(*prepared_);
    const auto is_enough = [&] { return before == wanted.scene; };
    before.camera = wanted.scene.camera;
    before.film.exposure = wanted.scene.film.exposure;
    change = is_enough()                                          ? camera
             : (before.lights = wanted.scene.lights, is_enough()) ? lights
             : (before.media = wanted.scene.media, is_enough())   ? media
                                                                  : anything;
  }
  prepared_.reset();
  session_->edit(wanted.scene);
  events_.planned(wanted.revision, session_->scene(), session_->plan(), session_->world().boxes);
  check_memory(session_->plan());
  Spent& spent = spent_[change];
  const bool is_direct = wanted.scene.settings.method == Method::direct;
  const double expected = expected_seconds(session_->scene(), session_->plan());
  if (expected > std::max(kSlow, kDearer * spent.expected)) spent = {};
  spent.expected = expected;
  const bool is_quick = spent.prepare < kFrame && !is_direct;
  const Stopwatch watch;
  const auto lit = is_quick && spent.final < kKnob ? nullptr : show_lit_anew(wanted, spent);
  StageCost relighting = watch.cost("shading");
  if (!is_quick && lit == nullptr) publish(wanted, PictureStep::moving, session_->first_light(&brief_));
  const Clock::time_point start = Clock::now();
  session_->prepare(is_quick ? &brief_ : &monitor_);
  spent.prepare = seconds_since(start);
  prepared_ = wanted.scene;
  refines_ = true;
  if (is_direct) return draw_direct(wanted);
  if (lit != nullptr && lit->step == PictureStep::final)
    return report(wanted, lit->image, estimated_relative_error(lit->image, lit->translucent),
                  std::move(relighting));
  if (lit != nullptr) return draw_final(wanted, spent, &monitor_);
  if (is_quick && spent.final < (change == camera ? kFrame : kKnob))
    return draw_final(wanted, spent, &brief_);
  const int stride = draft_stride(wanted.scene.film);
  draw_draft(wanted, stride, PictureStep::moving, &brief_);
  refine(wanted, spent, stride);
}

/// The last final image relit for the scene's lights, if possible; otherwise null.
std::shared_ptr<const ViewPicture> ViewRenderer::show_lit_anew(const Wanted& wanted, const Spent& spent) {
  if (final_ == nullptr || wanted.scene.settings.method == Method::direct) return nullptr;
  std::optional<LitAnew> lit = lit_anew(final_->image, *final_scene_, wanted.scene);
  if (!lit) return nullptr;
  // The duration of a final render is unknown before the first one.
  const bool is_final = lit->has_one_factor && std::isfinite(spent.final);
  return publish(wanted, is_final ? PictureStep::final : PictureStep::sharper, std::move(lit->image),
                 final_->translucent);
}

/// Ever sharper images, the first of them in kLongFinal, if the final one takes longer.
/// stride: of the image shown
void ViewRenderer::refine(const Wanted& wanted, Spent& spent, int stride) {
  advance(&monitor_, 0);
  const Film& film = wanted.scene.film;
  const auto expected = [&](int side) {
    return seconds_per_sharper_pixel_ * pixels_of(film) / (side * side);
  };
  const double last = std::isfinite(spent.final) ? spent.final : expected(1) * film.samples_per_pixel;
  while (stride > 1 && last > kLongFinal) {
    do stride /= 2;
    while (stride > 1 && expected(stride / 2) < kLongFinal);
    if (expected(stride) > last / 2) break;
    draft_ = draw_draft(wanted, stride, PictureStep::sharper, &monitor_);
  }
  draw_final(wanted, spent, &monitor_);
}

/// Finished pixels of the final image over those of the last draft.
void ViewRenderer::show_partial(const Wanted& wanted, Image&& image,
                                const std::vector<std::uint8_t>& is_final) {
  if (draft_ == nullptr || draft_->image.width != image.width || draft_->image.height != image.height ||
      draft_->image.channels != image.channels)
    return;
  const std::size_t channels = image.channels.size();
  for (std::size_t p = 0; p < is_final.size(); ++p)
    if (is_final[p] == 0)
      std::copy_n(&draft_->image.pixels[p * channels], channels, &image.pixels[p * channels]);
  publish(wanted, PictureStep::sharper, std::move(image));
}

int ViewRenderer::draft_stride(const Film& film) const {
  const double stride = std::sqrt(pixels_of(film) * seconds_per_pixel_ / kDraft);
  return int(std::ceil(std::clamp(stride, 1.0, double(kCoarsest))));
}

std::shared_ptr<const ViewPicture> ViewRenderer::draw_draft(const Wanted& wanted, int stride,
                                                            PictureStep step, Monitor* monitor) {
  Scene scene = session_->scene();
  double& seconds_per_pixel = step == PictureStep::moving ? seconds_per_pixel_ : seconds_per_sharper_pixel_;
  if (step != PictureStep::moving) scene.settings.light_samples = light_samples_of_ray(scene);
  scene.film = coarse_film(scene.film, stride);
  const Clock::time_point start = Clock::now();
  RenderInput input{scene, session_->world(), session_->rays(), session_->bodies(), monitor};
  input.bounced = session_->bounced_places();
  if (input.bounced == nullptr) scene.settings.bounces = 0;
  Image image = render(input).image;
  if (const auto& wavelengths = input.scene.wavelengths) convert_to_rgb(image, wavelengths->alone);
  const double seconds = seconds_since(start);
  seconds_per_pixel += .5 * (seconds / pixels_of(scene.film) - seconds_per_pixel);
  return publish(wanted, step, std::move(image));
}

void ViewRenderer::draw_final(const Wanted& wanted, Spent& spent, Monitor* monitor) {
  const Clock::time_point start = Clock::now();
  const Stopwatch watch;
  // The parts of an image in more than three wavelengths have no colours.
  if (monitor == &monitor_ && !wanted.scene.wavelengths)
    monitor_.show_partial = [&](Image&& image, const std::vector<std::uint8_t>& is_final) {
      show_partial(wanted, std::move(image), is_final);
    };
  RenderResult result = session_->render(monitor);
  monitor_.show_partial = {};
  spent.final = seconds_since(start);
  StageCost shading = watch.cost("shading");
  const auto picture =
      publish(wanted, PictureStep::final, std::move(result.image), std::move(result.translucent));
  final_ = picture;
  final_scene_ = wanted.scene;
  report(wanted, picture->image, estimated_relative_error(picture->image, picture->translucent),
         std::move(shading));
}

void ViewRenderer::draw_direct(const Wanted& wanted) {
  const Stopwatch watch;
  DirectState state;
  DirectResult result = render_direct(
      {session_->scene(), session_->world(), session_->rays(), session_->plan(), &monitor_}, state);
  StageCost shading = watch.cost("shading");
  const auto picture = publish(wanted, PictureStep::final, std::move(result.picture.image));
  report(wanted, picture->image, result.relative_error, std::move(shading));
}

std::shared_ptr<const ViewPicture> ViewRenderer::publish(const Wanted& wanted, PictureStep step, Image image,
                                                         std::vector<std::uint8_t> translucent) {
  const auto picture = std::make_shared<const ViewPicture>(ViewPicture{
      wanted.revision, step, seconds_since(wanted.since), std::move(image), std::move(translucent)});
  events_.picture(picture);
  return picture;
}

void ViewRenderer::report(const Wanted& wanted, const Image& image, double error, StageCost shading) {
  advance(&monitor_, 0);  // obsolete once there is a newer scene
  ViewReport report{wanted.revision, error, session_->costs(), session_->decisions(), {}};
  report.costs.push_back(std::move(shading));
  report.warnings = picture_warnings(wanted.scene, session_->world(), image);
  for (const Body& body : session_->bodies())
    for (std::string& text : method_of(body.plan.method).warnings(body, session_->world().unit))
      report.warnings.push_back(std::move(text));
  for (std::string& text : model_warnings(session_->plan())) report.warnings.push_back(std::move(text));
  for (std::string& text : placement_warnings(wanted.scene, session_->world(), session_->plan()))
    report.warnings.push_back(std::move(text));
  for (std::string& text :
       warnings_of_shapes_inside(wanted.scene, session_->world(), session_->rays(), session_->plan()))
    report.warnings.push_back(std::move(text));
  events_.report(report);
}

}  // namespace opaline
