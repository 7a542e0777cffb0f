// SPDX-License-Identifier: GPL-3.0-or-later
// Background work after a final image, during a pause of edits: settings for an error, the trade-off of error
// against time, and a progressively refined reference.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "methods/direct/direct.h"
#include "opaline/compare.h"
#include "quality/target_error.h"
#include "quality/trade.h"
#include "view/view_renderer.h"

namespace opaline {

/// Requested background work; initially none.
struct BackgroundWork {
  bool trade = false;
  std::optional<Method> reference;     ///< direct or volume
  std::optional<double> target_error;  ///< chooses settings by error; relative
  friend bool operator==(const BackgroundWork&, const BackgroundWork&) = default;
};

/// State of the reference.
struct ReferenceState {
  std::uint32_t revision = 0;
  Method method = Method::direct;
  std::size_t samples = 0;  ///< direct: entry samples per pixel; volume: walks per sample
  double noise = 0;         ///< relative, rms: direct: of its pixels; volume: of its cells
  double difference = 0;    ///< error_beyond_noise of the final diffuse image, over translucent pixels or all
};

/// State of the error-against-time table of a scene.
struct TradeState {
  std::uint32_t revision = 0;
  double mm_per_unit = 1;
  std::vector<TradePoint> points;
  std::optional<std::size_t> now;  ///< point with the scene's settings
  bool is_whole = false;
};

/// Result of choosing settings by error.
struct ChosenSettings {
  std::uint32_t revision = 0;  ///< revision of their scene
  TargetError outcome;
  std::vector<std::string> overrides;  ///< as in `--set`
};

/// Called on the background's thread.
struct BackgroundEvents {
  std::function<void(const TradeState& trade)> trade;
  std::function<void(std::shared_ptr<const ViewPicture> picture, const ReferenceState& state)> reference;
  std::function<void(const ChosenSettings& chosen)> chosen;
  std::function<void(std::uint32_t revision, const std::string& why)> failed;
};

/// Has its own session and thread, so interactive images neither depend on it nor wait for it. The session
/// exists only while work is requested.
class ViewBackground {
 public:
  explicit ViewBackground(BackgroundEvents events);
  /// Cancels running work and waits for its end.
  ~ViewBackground();
  ViewBackground(const ViewBackground&) = delete;
  ViewBackground& operator=(const ViewBackground&) = delete;

  /// Replaces the requested work, and restarts.
  void ask(const BackgroundWork& work);

  /// Notifies of a scene's final image; work on it begins a moment later.
  void start(Scene scene, std::shared_ptr<const ViewPicture> final_picture);

  /// Cancels running work after a change of the scene.
  void stop();

 private:
  struct Job {
    Scene scene;
    std::shared_ptr<const ViewPicture> shown;
  };

  void run();
  void work(const Job& job, const BackgroundWork& wanted);
  void choose(const Job& job, double target_error);
  void find_trade(const Job& job);
  bool keeps_trade(const Job& job) const;
  void tell_trade(const Job& job, bool is_whole);
  void refine_direct(const Job& job);
  void refine_volume(const Job& job);
  void publish(const Job& job, RenderResult result, const Layer& variance, ReferenceState state);

  BackgroundEvents events_;
  // Used by the thread only.
  std::unique_ptr<Session> session_;
  std::optional<Scene> trade_scene_;  ///< scene of the points, complete
  std::vector<TradePoint> points_;
  DirectState direct_;  ///< sums for the scene of this revision; other requests keep them
  std::uint32_t direct_revision_ = 0;
  Monitor monitor_;
  std::mutex mutex_;  // guards the next three
  BackgroundWork asked_;
  std::optional<Job> job_;
  bool stopped_ = false, changed_ = false;
  std::condition_variable news_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace opaline
