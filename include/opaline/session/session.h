// SPDX-License-Identifier: GPL-3.0-or-later
// A scene that is edited and rendered again and again: what an edit leaves valid is kept.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "opaline/render/first_light.h"
#include "opaline/render/render.h"
#include "opaline/session/session_work.h"
#include "opaline/session/stage_cache.h"

namespace opaline {

/// Keeps the last scene's stage results, each with the key of what it was computed from; the next scene takes
/// over those with equal keys, looks for the others in the cache, and computes what is left:
///
///   edit                                what is computed
///   camera, film                        camera rays and what they see; a surface cache is looked up again.
///                                       Other edits trace these rays again, too, unless the view is held
///   a light's colour or power           sums over lights, trees; no ray from a sample.
///   a medium                            evaluation; its samples stay while they are dense enough and at most
///                                       twice as dense (in spacing) as it asks for
///   eta                                 the light that enters, trees, evaluation
///   a light moved, added or removed     that light's share, trees, evaluation
///   any of many lights (ManyLights)     the share of all of them, also for a colour; trees, evaluation
///   an object moved as a whole          no file is read; its samples go along; light that enters it, and
///                                       others where the shadow of a ball around it fell or falls
///   a mesh bent, the same triangles     the mesh is read, not checked; samples and their cells move with their
///                                       triangles (carry_samples); everything else of it is computed again.
///                                       Samples are placed anew if carrying would make them more than both
///                                       settings.max_samples and twice their first number, or, where that
///                                       number was set or limited by max_samples, less than a sixteenth of it
///   anything else                       what depends on it
///
/// Random walks (Method::volume) are kept by light, where lights are few: neither the camera nor colours walk again,
/// and other edits walk for the lights they concern.
///
/// A picture has the same bits as that of a new session, with two exceptions: random walks that were made for a
/// smaller error (walks are not taken back), and scenes whose samples were carried along or stayed denser than needed.
/// Such samples were placed on the last surface that was sampled anew. The picture depends on that surface and on the
/// scene as it is now, not on the edits in between.
class Session {
 public:
  /// cache: where to look for what is not at hand, and to keep it; null: nowhere. Outlives the session.
  explicit Session(StageCache* cache = nullptr);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Chooses the bodies' profiles (choose_models.h), which all later scenes take over. With methods that have samples it
  /// places the scene's and holds on to them: every later scene carries these along, or, where its
  /// surfaces are others, has its own without forgetting them. So frames of a shot are the same whichever
  /// process renders which of them.
  /// error as edit
  void anchor(Scene scene, Monitor* monitor = nullptr);

  /// Takes the scene as it is now: loads meshes that changed and plans. Samples at hand may change the plan.
  /// error as make_world; the session then holds the scene before
  void edit(Scene scene);

  /// How many pictures are to be made of the same surfaces in the same light, 1 at first: with the evaluator
  /// `automatic` a surface cache is made if it pays for all of them.
  void expect_pictures(std::size_t pictures);

  /// Enables the cache of the view: camera hits, their light by source, and gathering rays, reused by later images. An edit
  /// of colours or media then traces none of them again, and no specular reflection of rough boundaries without textures and
  /// metals; smooth boundaries are traced again. Costs memory (HeldView). Off by default.
  void hold_view(bool hold);

  /// True if each picture has the bits of a new session's. Samples are then placed anew wherever a new session
  /// would have others, neither carried along nor left denser than needed. Default: false.
  void match_new_session(bool matches);

  /// If no further edits follow, the session drops the data that only edits reuse. Default: true. No picture
  /// depends on it.
  void expect_edits(bool edits);

  /// Sums of random walks to go on from, and where to keep them.
  void store_walks(WalkStore store);

  /// The ray structure alone, which prepare has made otherwise.
  void prepare_rays();

  /// A coarse picture (first_light.h) of the scene, which needs nothing of prepare but the rays.
  Image first_light(Monitor* monitor = nullptr);

  /// Computes what the scene needs for its method and is not there; a second call does nothing. In a scene
  /// without lights that is nothing: it is rendered as by Method::lambert.
  /// error Error{interrupted}: what was complete stays
  void prepare(Monitor* monitor = nullptr);

  /// The picture of the scene; prepares it first.
  RenderResult render(Monitor* monitor = nullptr);

  /// The scene of the last edit, with the profiles that were chosen.
  const Scene& scene() const;
  /// Its meshes around one origin.
  const World& world() const;
  /// Stages, samples and memory of the scene.
  const Plan& plan() const;
  const RayScene& rays() const;  ///< after prepare
  /// After prepare; none where the method or the plan has none.
  std::span<const Body> bodies() const;
  /// Bounced places of the last picture in which light bounced, of whichever view and light; null: none of these shapes.
  std::shared_ptr<const BouncedPlaces> bounced_places() const;
  const SessionWork& work() const;  ///< work of the last edit and since
  /// Decisions on reused and recomputed stages, a line each.
  const std::vector<std::string>& decisions() const;
  /// Rays, sampling, irradiance, octree, and exitance where there are surface caches.
  const std::vector<StageCost>& costs() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace opaline
