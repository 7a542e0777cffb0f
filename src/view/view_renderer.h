// SPDX-License-Identifier: GPL-3.0-or-later
// Progressive images of the newest scene, coarse to final, on a thread of its own.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "opaline/monitor.h"
#include "session/session_records.h"

namespace opaline {

/// moving: the result of a thirtieth of a second; sharper: more pixels and the same samples, the finished parts
/// of the final image over such pixels, or the last final image relit (lit_anew.h); final: the bytes of `opaline render`, or the last final image scaled, if
/// all lights changed by one factor and a new render takes long. reference: of another method, for comparison
/// (view_background.h).
enum class PictureStep : std::uint32_t { moving, sharper, final, reference };

struct ViewPicture {
  std::uint32_t revision = 0;
  PictureStep step = PictureStep::moving;
  double seconds = 0;                          ///< from the edit to this image
  Image image;                                 ///< R G B A first
  std::vector<std::uint8_t> translucent = {};  ///< mask of a final image, as in RenderResult; empty: unknown
};

/// Report on a final image.
struct ViewReport {
  std::uint32_t revision = 0;
  double error = 0;                 ///< estimated_relative_error, or `direct`'s noise
  std::vector<StageCost> costs;     ///< costs of this change
  std::vector<std::string> reused;  ///< Session::decisions
  std::vector<std::string> warnings;
};

/// Called on the renderer's thread; picture also on threads of the shading.
struct ViewEvents {
  /// boxes: of the shapes, mm
  std::function<void(std::uint32_t revision, const Scene& scene, const Plan& plan,
                     std::span<const Bounds> boxes)>
      planned;
  std::function<void(std::shared_ptr<const ViewPicture> picture)> picture;
  std::function<void(const ViewReport& report)> report;
  std::function<void(std::uint32_t revision, const std::string& why)> failed;
  /// shape: its index in the scene; none: the pixel shows none
  std::function<void(std::optional<std::size_t> shape)> picked;
};

/// error Error{run_failed}: the image needs more memory than available
void check_memory(const Plan& plan);

class ViewRenderer {
 public:
  explicit ViewRenderer(ViewEvents events);
  /// Cancels running work and waits for its end.
  ~ViewRenderer();
  ViewRenderer(const ViewRenderer&) = delete;
  ViewRenderer& operator=(const ViewRenderer&) = delete;

  /// Replaces a waiting scene, and cancels the images of the current one. An image due within a frame's time
  /// is still shown, so continuous edits show images.
  /// reference: for a scene with frames, the scene with the surfaces of all frames' samples (Session::anchor)
  /// has_new_files: files of an equal scene have changed
  void show(Scene scene, std::uint32_t revision, std::optional<Scene> reference = {},
            bool has_new_files = false);

  /// Finds the shape at a pixel of the image before the next scene is drawn; replaces a waiting request.
  void pick(int x, int y);

  /// Progress of the current work.
  const Monitor& monitor() const { return monitor_; }
  bool is_drawing();
  /// True if it draws an image of prepared stages: an interruption loses little.
  bool can_interrupt() const { return refines_; }
  /// Ends long interactive work, which newer scenes do not cancel, if a scene waits. Call regularly during
  /// drawing.
  void end_stale_work();

 private:
  using Clock = std::chrono::steady_clock;
  struct Wanted {
    Scene scene;
    std::optional<Scene> reference;
    std::uint32_t revision = 0;
    Clock::time_point since;
    bool has_new_files = false;
  };
  /// Kind of an edit, deciding the stages to recompute.
  enum Change : std::size_t { camera, lights, media, anything, kChanges };
  /// Cost of the last change of each kind, s.
  struct Spent {
    double prepare = std::numeric_limits<double>::infinity();
    double final = std::numeric_limits<double>::infinity();
    double expected = 0;  ///< expected_seconds of its scene
  };

  void run();
  std::optional<Wanted> next();
  void restart();
  std::optional<std::size_t> shape_at(const std::array<int, 2>& pixel) const;
  void draw(const Wanted& wanted);
  void anchor(const Wanted& wanted);
  std::shared_ptr<const ViewPicture> show_lit_anew(const Wanted& wanted, const Spent& spent);
  void refine(const Wanted& wanted, Spent& spent, int stride);
  void show_partial(const Wanted& wanted, Image&& image, const std::vector<std::uint8_t>& is_final);
  void draw_final(const Wanted& wanted, Spent& spent, Monitor* monitor);
  void draw_direct(const Wanted& wanted);
  std::shared_ptr<const ViewPicture> draw_draft(const Wanted& wanted, int stride, PictureStep step,
                                                Monitor* monitor);
  int draft_stride(const Film& film) const;
  std::shared_ptr<const ViewPicture> publish(const Wanted& wanted, PictureStep step, Image image,
                                             std::vector<std::uint8_t> translucent = {});
  void report(const Wanted& wanted, const Image& image, double error, StageCost shading);

  ViewEvents events_;
  std::unique_ptr<Session> session_;
  std::optional<Scene> prepared_;
  std::atomic<bool> refines_ = false;  ///< draws from prepared_
  std::optional<Scene> anchor_;        ///< scene anchoring the session, without values irrelevant to samples
  std::shared_ptr<const ViewPicture> draft_;  ///< the last one of the current scene
  std::shared_ptr<const ViewPicture> final_;  ///< the last one, of final_scene_
  std::optional<Scene> final_scene_;
  std::array<Spent, kChanges> spent_;
  double seconds_per_pixel_ = 2e-6, seconds_per_sharper_pixel_ = 2e-6;  // costs of drafts
  Monitor monitor_;
  Monitor brief_;     ///< monitor of interactive work
  std::mutex mutex_;  // guards the next five
  std::optional<Wanted> wanted_;
  std::optional<std::array<int, 2>> picked_;
  Clock::time_point drawing_since_;
  bool stopped_ = false, is_drawing_ = false;
  std::condition_variable changed_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace opaline
