// SPDX-License-Identifier: GPL-3.0-or-later
// The newest scene as pictures: a coarse one at once, then sharper ones, on a thread of its own.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "opaline/monitor.h"
#include "session/session_records.h"

namespace opaline {

/// moving: whatever is there within a thirtieth of a second; sharper: more pixels, the same samples, or the last final
/// picture in light of another colour (lit_anew.h); final: the bits of `opaline render`, or, where all light is brighter or
/// darker by one factor and those bits are known to take long, the last final picture times it. reference: of another
/// method, for comparison (view_background.h).
enum class PictureStep : std::uint32_t { moving, sharper, final, reference };

struct ViewPicture {
  std::uint32_t revision = 0;
  PictureStep step = PictureStep::moving;
  double seconds = 0;                          ///< from the change to this picture
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

/// Called on the renderer's thread.
struct ViewEvents {
  std::function<void(std::uint32_t revision, const Scene& scene, const Plan& plan)> planned;
  std::function<void(std::shared_ptr<const ViewPicture> picture)> picture;
  std::function<void(const ViewReport& report)> report;
  std::function<void(std::uint32_t revision, const std::string& why)> failed;
};

/// error Error{run_failed}: the picture needs more memory than the machine has left
void check_memory(const Plan& plan);

class ViewRenderer {
 public:
  explicit ViewRenderer(ViewEvents events);
  /// Cancels what is under way and waits for its end.
  ~ViewRenderer();
  ViewRenderer(const ViewRenderer&) = delete;
  ViewRenderer& operator=(const ViewRenderer&) = delete;

  /// Takes the place of a scene that waits, and cancels the pictures of the one under way; what is on its way within
  /// a frame's time is still shown, so a knob turning without pause shows pictures.
  /// reference: of a scene with frames, the one whose surfaces all frames' samples are placed on (Session::anchor)
  void show(Scene scene, std::uint32_t revision, std::optional<Scene> reference = {});

  /// For whoever shows progress.
  const Monitor& monitor() const { return monitor_; }
  bool is_drawing();
  /// Ends work following the hand, which no newer scene cancels, where it takes long and one waits. To be called now
  /// and then while it draws.
  void end_stale_work();

 private:
  using Clock = std::chrono::steady_clock;
  struct Wanted {
    Scene scene;
    std::optional<Scene> reference;
    std::uint32_t revision = 0;
    Clock::time_point since;
  };
  /// Kind of a change; it decides which stages are computed again.
  enum Change : std::size_t { camera, lights, media, anything, kChanges };
  /// Cost of the last change of each kind, s.
  struct Spent {
    double prepare = std::numeric_limits<double>::infinity();
    double final = std::numeric_limits<double>::infinity();
  };

  void run();
  std::optional<Wanted> next();
  void draw(const Wanted& wanted);
  void anchor(const Wanted& wanted);
  std::shared_ptr<const ViewPicture> show_lit_anew(const Wanted& wanted, const Spent& spent);
  void refine(const Wanted& wanted, Spent& spent);
  void draw_final(const Wanted& wanted, Spent& spent, Monitor* monitor);
  void draw_direct(const Wanted& wanted);
  void draw_draft(const Wanted& wanted, int stride, PictureStep step, Monitor* monitor);
  int draft_stride(const Film& film) const;
  std::shared_ptr<const ViewPicture> publish(const Wanted& wanted, PictureStep step, Image image,
                                             std::vector<std::uint8_t> translucent = {});
  void report(const Wanted& wanted, const Image& image, double error, StageCost shading);

  ViewEvents events_;
  std::unique_ptr<Session> session_;
  std::optional<Scene> prepared_;
  std::optional<Scene> anchor_;  ///< that the session is anchored at, without what samples do not depend on
  std::shared_ptr<const ViewPicture> final_;  ///< the last one, of final_scene_
  std::optional<Scene> final_scene_;
  std::array<Spent, kChanges> spent_;
  double seconds_per_pixel_ = 2e-6;  // cost of drafts
  Monitor monitor_;
  Monitor brief_;     ///< monitor of interactive work
  std::mutex mutex_;  // guards the next four
  std::optional<Wanted> wanted_;
  Clock::time_point drawing_since_;
  bool stopped_ = false, is_drawing_ = false;
  std::condition_variable changed_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace opaline
