// SPDX-License-Identifier: GPL-3.0-or-later
// Cached state of a session, and the update of each part of it after an edit.
#pragma once

#include "session/session_records.h"
#include "session/shape_key.h"
#include "stages/body_keys.h"
#include "subsurface/method.h"

namespace opaline {

struct Session::State {
  explicit State(StageCache* cache) : cache_(cache) {}

  /// Cached result of loading a shape, with the key of its source; zeros if loading failed.
  struct ShapeMemory {
    std::string name;
    StageKey source;
    MeshMemory mesh;
  };

  // Implementations of Session's functions of the same names.
  void anchor(Scene scene, Monitor* monitor);
  void edit(Scene scene);
  void prepare_rays();
  Image first_light(Monitor* monitor);
  void prepare(Monitor* monitor);
  RenderResult channels_image(Monitor* monitor);
  RenderResult spectral_image(Monitor* monitor);

  bool is_needed() const { return method_of(scene_.settings.method).needs_bodies() && !plan_.groups.empty(); }
  /// Bodies used by the image: none if the method or the plan has none, even if later scenes may reuse some.
  std::span<const Body> bodies() const { return is_needed() ? bodies_ : std::span<const Body>{}; }
  void arrange_memories(const Scene& scene, const std::vector<StageKey>& sources);
  World loaded_world(const Scene& scene, const std::vector<StageKey>& sources,
                     const std::vector<StageKey>& shapes, SessionWork& work);
  void keep_cells();
  void keep_spacing();
  void update_rays();
  std::size_t pose_stride(std::size_t shape) const;
  std::vector<MeshMotion> mesh_motions() const;
  void arrange_bodies();
  void update_samples(Body& body, BodyKeys& known, const PrecomputeInput& input, std::size_t group);
  void reuse_samples(Body& body, BodyKeys& known);
  void cut_new_samples(Body& body, BodyKeys& known, const PrecomputeInput& input);
  void place_new_samples(Body& body, BodyKeys& known, const PrecomputeInput& input, std::size_t group,
                         const StageKey& key);
  void carry_samples(Body& body, BodyKeys& known, const PrecomputeInput& input, const StageKey& key);
  void update_lights(Body& body, BodyKeys& known, const PrecomputeInput& input, std::size_t group,
                     const std::vector<Light>& lights);
  void update_tint(Body& body, BodyKeys& known);
  std::vector<std::vector<RgbF>> cached_bounces(std::span<const StageKey> keys);
  void update_bounces(std::span<BodyStages> stages);
  /// Transmitted irradiance at the samples of each body from surfaces; all bounces between bodies whose methods
  /// support re-entry, one otherwise.
  std::vector<std::vector<RgbF>> gathered_bounces(std::span<BodyStages> stages);
  HeldView* held_view();
  HeldView* held_view_of_samples(const PrecomputeInput& input);
  void update_bounced_places(const RenderInput& input);
  void note_decision(const Body& body, const std::string& text) { store_.note(body.plan.name, text); }
  std::vector<BodyStages> body_stages(const PrecomputeInput& input, std::span<const Light> lights);

  StageCache* cache_;
  Scene scene_;
  std::shared_ptr<const World> world_;
  std::vector<StageKey> shape_keys_;  // source of each mesh
  std::vector<ShapeMemory> shape_memories_;
  std::vector<MeshKeys> mesh_keys_;
  std::vector<Light> emitters_;  // lights of shapes: hold their surfaces between stages
  Plan plan_;
  std::unique_ptr<RayScene> rays_;
  RayBuild rays_build_ = RayBuild::careful;
  std::vector<MeshKeys> rays_keys_;
  std::vector<ShutterPose> moved_by_;  // motion of the rays' meshes
  std::vector<Body> bodies_;
  std::vector<BodyKeys> keys_;  // one per body
  std::size_t pictures_ = 1;
  bool holds_view_ = false, keeps_wavelengths_ = false;
  HeldView view_;
  std::shared_ptr<const BouncedPlaces> bounced_;  // cache points of the last image with bounces
  StageKey bounced_key_;
  StageKey view_key_, view_surfaces_key_, view_coats_key_, view_near_key_, view_samples_key_;
  std::vector<StageKey> view_light_keys_;
  std::vector<BodyPlan> reference_;  ///< plans of the anchor; empty: none
  double cell_size_ = 0;             ///< settings.cell_size of the last scene
  bool edits_ = true, prepared_ = false, anchored_ = false, matches_new_ = false;
  std::vector<std::uint16_t> adaptive_rays_;  // AdaptiveRays::rays of the last image
  bool repeats_rays_ = false;
  SourceKeys source_keys_;
  WalkStore walk_store_;
  SessionWork work_;
  std::vector<std::string> decisions_;
  std::vector<StageCost> costs_;
  StageStore store_{cache_, work_, decisions_};
};

}  // namespace opaline
