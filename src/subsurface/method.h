// SPDX-License-Identifier: GPL-3.0-or-later
// Interface of a method: one way to compute the exitance of translucent bodies.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/evaluate.h"
#include "opaline/session.h"
#include "subsurface/body_stages.h"
#include "subsurface/field.h"
#include "subsurface/method_layers.h"
#include "subsurface/planning.h"
#include "subsurface/render_input.h"

namespace opaline {

/// CPU time of a shadow ray, s, by bench_plan.
inline constexpr double kSecondsOfShadowRay = 1e-7;

/// Method of subsurface transport, one folder in methods/. Its results for a body are in Body::states.
class SubsurfaceMethod {
 public:
  virtual ~SubsurfaceMethod() = default;

  /// Requirements: samples over the surface, and light transmitted into the body there.
  virtual bool needs_samples() const { return true; }
  /// True if bodies have a state from `prepare`; false: each hit is shaded by itself.
  virtual bool needs_bodies() const { return needs_samples(); }
  virtual bool needs_transmitted_light() const { return true; }
  /// True if textures of a medium vary it inside a body, closed or open (TextureMix::medium), not just at its
  /// surface.
  virtual bool follows_textures_inside(bool /*is_closed*/) const { return false; }
  /// True if light spreads by the radial profile of the medium, or its total reflectance alone is used.
  virtual bool uses_radial_profile() const { return true; }
  /// False if light leaves where it enters.
  virtual bool spreads_light() const { return true; }
  /// True if the exitance may be evaluated at points of the surface instead of hits (surface_caches.h).
  virtual bool may_use_surface_cache() const { return false; }
  /// Layers of an image beside those of every method.
  virtual MethodLayers layers() const { return {.variance = false, .error = true}; }
  /// False if no model stands between the method and random walks.
  virtual bool has_model() const { return true; }
  /// Relative error of the model, against random walks; none: unknown.
  virtual std::optional<double> expected_error(const BodyModel& model) const { return model.expected_error; }
  /// False if surfaces cannot light each other.
  virtual bool supports_bounces() const { return true; }
  /// True if light leaving a body alone in the scene may enter it again.
  virtual bool supports_reentry() const { return false; }
  /// Rays gathering bounced light at a sample; few, because the medium blurs neighbouring samples.
  virtual int gathered_rays() const { return 16; }
  /// True if the image of a light alone equals its contribution to the image of all lights, noise included.
  virtual bool separates_lights() const { return true; }

  // Plan.

  /// Chooses the samples of a body, or another method for it.
  virtual void plan(const PlanningInput& input, BodyPlan& body, std::vector<std::string>& warnings) const;
  virtual BodyMemory memory(const PlanningInput&, const BodyPlan&) const { return {}; }
  /// CPU time to prepare a body, and to shade a pixel besides its camera rays, s.
  virtual double seconds(const Scene&, const BodyPlan&, const Lighting&) const { return 0; }
  virtual double seconds_of_pixel(const Scene&, const Lighting&) const { return 0; }
  /// Samples tracing shadow rays; infinite: enough rays that a careful build of their structure always pays
  /// off.
  virtual double samples_with_shadow_rays(const Plan&) const { return INFINITY; }
  /// Lines of the plan: how light reaches the bodies; one body; all bodies; bounces; shading.
  virtual std::string light_stage(const Scene& scene, std::span<const Light> lights) const;
  virtual std::string body_stage(const BodyPlan&) const { return {}; }
  virtual void list_stages(const Scene&, std::vector<std::string>&) const {}
  virtual std::string bounces_stage() const;
  virtual std::string shading_stage(const Scene& scene) const = 0;

  // Preparation.

  /// Name of the stage `prepare` in the table of costs.
  virtual const char* stage() const { return ""; }
  /// Updates the state for the lights. If light bounces, it may keep the state of a previous call with
  /// bounced light in the same direct light.
  /// error Error{interrupted}
  virtual void prepare(BodyStages&) const {}
  /// Key of the radiant exitance under the lights alone.
  virtual StageKey direct_key(const Body&) const { return {}; }
  /// Key of the bounced light in the state; zero: none.
  virtual StageKey bounced_key(const Body&) const { return {}; }
  /// Removes bounced light from the state.
  virtual void remove_bounced(BodyStages&) const {}
  /// Adds light from other surfaces.
  /// in    bounced: transmitted irradiance, one per sample; key: its key
  virtual void add_bounced(BodyStages&, std::span<const RgbF> /*bounced*/, const StageKey& /*key*/) const {}
  /// Adds bounced light to the state, for gathering the next bounce; needed for supports_reentry() only.
  virtual void add_for_gathering(BodyStages&, std::span<const RgbF> /*bounced*/) const {}
  /// A state under the lights alone, for light gathered from this body.
  virtual std::unique_ptr<MethodState> direct_state(const BodyStages&) const { return nullptr; }
  /// Last step, once all light is there. Returns true if it computed or reused anything.
  virtual bool finish(BodyStages&) const { return false; }

  /// Transmitted irradiance at the samples from lights and other surfaces; empty: not computed.
  virtual std::span<const RgbF> irradiance(const Body&) const { return {}; }
  /// Defects of the meshes, one line each.
  virtual std::vector<std::string> warnings(const Body&, double /*unit*/) const { return {}; }
  /// Radiant exitance at points of the body's surface.
  /// in    body: prepared; points: in the world's space and unit
  virtual std::vector<RgbF> exitance_at(const Body&, std::span<const Query> /*points*/,
                                        const Settings&) const {
    return {};
  }
  /// Radiant exitance at hits.
  /// in    body: prepared; must outlive the field, as the input
  virtual std::unique_ptr<Field> field(const RenderInput&, const Body&) const { return nullptr; }
  /// The image, by a method that sums passes over it; none: the renderer shades the fields.
  virtual std::optional<RenderResult> render_image(const PrecomputeInput&) const { return {}; }
};

const SubsurfaceMethod& method_of(Method method);

/// True if light from other surfaces or from the same body is gathered at the samples of a body.
bool gathers_light(const Scene& scene, const BodyPlan& body);
/// True if light could enter a body again, but is not gathered.
bool leaves_out_reentry(const Scene& scene, const BodyPlan& body);

/// Radiant exitance at arbitrary points of a body's surface. For mean free paths below the sample spacing,
/// `render` traces shadow rays for the irradiance at its points; this function interpolates it.
/// in    body: prepared; points: world space, mm; normals: unit, outward, one per point
/// out   M_o in W/mm^2, one per point
std::vector<RgbF> radiant_exitance(const Body& body, const World& world, std::span<const Vec3d> points,
                                   std::span<const Vec3f> normals, const Settings& settings);

}  // namespace opaline
