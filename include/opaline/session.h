// SPDX-License-Identifier: GPL-3.0-or-later
// A session: edits and renders a scene repeatedly, and reuses all valid stage results.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "opaline/image.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"

namespace opaline {

// Internal records, defined by the headers in session/session_records.h.
class BouncedPlaces;
class RayScene;
class StageCache;
struct Body;
struct Plan;
struct SessionWork;
struct StageCost;
struct WalkStore;
struct World;

/// Camera rays of an image by its estimated error.
struct AdaptiveRays {
  std::vector<std::uint16_t> rays;  ///< per pixel; empty: film.samples_per_pixel in all
  double noise = 0;                 ///< estimated relative noise of the radiance, as for settings.until_error
  bool has_reached_most =
      false;                  ///< true if the bound of rays per pixel stopped it above settings.until_error
  double settings_error = 0;  ///< estimated_relative_error without antialiasing
};

struct RenderResult {
  /// R G B A, diffuse, specular, albedo, N, P, Z, irradiance, error; linear Rec.709, radiance W/(mm^2 sr).
  Image image;
  std::vector<std::uint8_t> translucent;  ///< per pixel: 1 if most of its covered part is translucent
  std::size_t queries = 0;                ///< points with evaluated exitance
  std::size_t non_finite = 0;             ///< pixels of non-finite radiance; 0 unless something is broken
  AdaptiveRays adaptive = {};             ///< camera rays by settings.until_error
};

/// Mean over the lit pixels of the estimated |error| / max(diffuse, 1e-3 of its p99) from the `error` layer,
/// worst channel; 0 without that layer.
/// in    counted: mask of pixels as in RenderResult::translucent; empty or all 0: all pixels
/// out   within a factor 2 of the measured mean in most scenes at most settings (bench_error_estimate)
double estimated_relative_error(const Image& image, std::span<const std::uint8_t> counted = {});

/// estimated_relative_error of an image, antialiasing excluded.
double settings_error(const RenderResult& result);

/// Caches the stage results of the last scene, each with the key of its inputs. The next scene reuses results
/// with equal keys, looks up the others in the disk cache, and computes the rest:
///
///   edit                              computed again
///   camera, film                      camera rays and their hits; lookups in a surface cache. Other edits
///                                     trace these rays again, too, unless hold_view is on
///   a light's colour or power         sums over lights, octrees; no ray from a sample
///   a medium                          evaluation; samples are reused while they are dense enough, and at
///                                     most twice as dense (in spacing) as required
///   eta                               transmitted irradiance, octrees, evaluation
///   a light moved, added or removed   contribution of that light, octrees, evaluation
///   any of many lights (ManyLights)   contribution of all of them, also after a change of colour; octrees,
///                                     evaluation
///   an object moved as a whole        no file is read; its samples move with it; its irradiance, and that of
///                                     others within the old or new shadow of its bounding sphere
///   a mesh bent, the same triangles   the mesh is read, not checked; samples and their cells move with their
///                                     triangles (carry_samples); all its other results are computed again.
///                                     Samples are placed again if carrying would give more than both
///                                     settings.max_samples and twice their first number, or, if that number
///                                     was set or limited by max_samples, less than a sixteenth of it
///   anything else                     the dependent stages
///
/// Random walks (Method::volume) are stored by light if lights are few: edits of the camera or of colours
/// trace none, and other edits trace only those of the affected lights.
///
/// An image is bit-identical to that of a new session, with two exceptions: random walks traced for a smaller
/// error (walks are never removed), and scenes with samples that moved with the surface or stayed denser than
/// required. Such samples were placed on the surface of the last complete sampling. The image depends on that
/// surface and on the current scene, not on the edits in between.
class Session {
 public:
  /// cache: disk cache to look up and store results; null: none. Must outlive the session.
  explicit Session(StageCache* cache = nullptr);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Chooses the profiles of the bodies for all later scenes. For methods with samples,
  /// also places the samples of this scene: later scenes move them along, or place others on different
  /// surfaces without discarding these. The frames of a shot are therefore equal in any process, for any
  /// subset of frames.
  /// error as edit
  void anchor(Scene scene, Monitor* monitor = nullptr);

  /// Sets the scene: loads changed meshes and plans. Existing samples may change the plan.
  /// error as make_world; the session then keeps the previous scene
  void edit(Scene scene);

  /// Sets the number of images of the same surfaces in the same light, 1 by default: the evaluator
  /// `automatic` makes a surface cache if it pays for all of them.
  void expect_pictures(std::size_t pictures);

  /// Enables the cache of the view: camera hits, their light by source, and gathering rays, reused by later
  /// images. An edit of colours or media then traces none of them again, and no specular reflection of rough
  /// boundaries without textures and metals; smooth boundaries are traced again. Costs memory (HeldView). Off
  /// by default.
  void hold_view(bool hold);

  /// If true, each image is bit-identical to that of a new session: samples are placed again, instead of
  /// moving along or staying denser than required, if a new session would place others. Default: false.
  void match_new_session(bool matches);

  /// False: frees the data needed by further edits only. Default: true. No image depends on it.
  void expect_edits(bool edits);

  /// Sums of random walks to resume from, and their storage.
  void store_walks(WalkStore store);

  /// Builds the ray structure only; prepare builds it otherwise.
  void prepare_rays();

  /// Coarse preview of the scene; requires only the rays.
  Image first_light(Monitor* monitor = nullptr);

  /// Computes all missing stages for the method; a second call does nothing. A scene without lights has no
  /// stages: it is rendered as by Method::lambert.
  /// error Error{interrupted}: complete stages remain
  void prepare(Monitor* monitor = nullptr);

  /// True: images of scenes with spectra also have a channel for each wavelength, named as "S0.443,15nm".
  void keep_wavelengths(bool keeps);

  /// Renders the scene; prepares it first. With settings.until_error and a method other than `direct` and `volume`, camera
  /// rays continue until this noise (AdaptiveRays).
  RenderResult render(Monitor* monitor = nullptr);

  /// True: further images have the camera rays of the last one, if these were adaptive. Default: false.
  void repeat_adaptive_rays(bool repeats);

  /// Radiant exitance at points of a body's surface; prepares the scene first. For mean free paths below the
  /// sample spacing, `render` traces shadow rays for the irradiance at its points; this function interpolates
  /// it.
  /// in    body: index of a translucent shape or group, in the order of the scene; points: world space, mm;
  ///       normals: unit, outward, one per point
  /// out   M_o in W/mm^2, one per point; with spectra, at the first three wavelengths
  /// error as prepare; Error{bad_input}: no such body, or a method without bodies
  std::vector<RgbF> radiant_exitance(std::size_t body, std::span<const Vec3d> points,
                                     std::span<const Vec3f> normals);

  /// Scene of the last edit, with the chosen profiles.
  const Scene& scene() const;
  /// Decisions on reused and recomputed stages, a line each.
  const std::vector<std::string>& decisions() const;

  // Internal results, for the program and its tests.

  /// Meshes of the scene around one origin.
  const World& world() const;
  /// Stages, samples and memory of the scene.
  const Plan& plan() const;
  const RayScene& rays() const;  ///< after prepare
  /// Bodies after prepare; empty for a method or plan without bodies.
  std::span<const Body> bodies() const;
  /// Indirect light of the last image with bounces, for any view and light; null: none for these shapes.
  std::shared_ptr<const BouncedPlaces> bounced_places() const;
  /// AdaptiveRays::rays of the last image.
  std::span<const std::uint16_t> adaptive_rays() const;
  const SessionWork& work() const;  ///< work of the last edit and since
  /// Costs of the stages that ran.
  const std::vector<StageCost>& costs() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace opaline
