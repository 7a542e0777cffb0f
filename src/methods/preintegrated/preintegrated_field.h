// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance at hits from the light there and the curvature, as of a ball.
#pragma once

#include <memory>
#include <vector>

#include "bodies/body.h"
#include "methods/preintegrated/sphere_response.h"
#include "stages/stage_store.h"
#include "subsurface/field.h"
#include "subsurface/render_input.h"

namespace opaline {

/// Response of a medium, the same for all its bodies.
struct MediumResponse {
  SphereResponse ball;
  RgbF kept;        ///< contrast of detail finer than the width, in each channel
  RgbF total;       ///< exitance of a flat body over even transmitted irradiance
  float width = 0;  ///< blur of details, world units; 0: none, light leaves where it enters
};
MediumResponse make_response(const Medium& medium, const World& world);

/// Surface of a mesh, blurred over the travel distance of light; at its vertices. Empty: not blurred.
struct SmoothSurface {
  std::vector<Vec3f> normals;
  std::vector<float> curvatures;
};
SmoothSurface smoothed(const Mesh& mesh, float width);

struct PreintegratedState : MethodState {
  static constexpr Method kMethod = Method::preintegrated;
  StageResult<std::shared_ptr<const MediumResponse>> response;
  StageResult<std::vector<SmoothSurface>> surfaces;  ///< one per mesh of the body
};

class PreintegratedField : public Field {
 public:
  PreintegratedField(const RenderInput& input, const Body& body);

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return boundary_; }
  bool asks_irradiance() const override { return true; }
  bool reflects() const override { return true; }

 private:
  struct Place {
    Vec3f normal;  // blurred
    Vec3f unbent;  // shading normal without maps
    float curvature = 0;
  };
  /// Light of one direction at a hit.
  struct Incident {
    std::uint32_t hit;
    Vec3f towards;
    float distance;       // to the light
    RgbF irradiance;      // across the direction
    float thickness = 0;  // body along the ray to a light behind it; 0: the hit faces the light
  };
  Place smooth_at(const SurfacePoint& point, const Hit& hit, bool is_bent) const;
  Place through(const Place& place, const Vec3f& towards, float thickness) const;
  float first_occluder(const Place& place, const Vec3f& towards, float thickness) const;
  static Vec3f below(const SurfacePoint& point);
  /// in    lights: sharing their rays
  void add_lights(const PointIrradianceInput& lighting, std::span<const Light> lights,
                  std::span<const Place> smooth, LeavingLight& result) const;
  void find_thickness(std::span<const SurfacePoint> points, std::span<Incident> incident) const;
  void add_unoccluded(std::span<const SurfacePoint> points, std::span<const Place> smooth,
                      std::span<Incident> incident, LeavingLight& result) const;
  /// Response of the smooth surface, plus the remaining detail.
  RgbF response(const Place& place, const Vec3f& normal, const Vec3f& towards) const;

  const RayScene& rays_;
  const World& world_;
  const MediumResponse& medium_;
  std::vector<const SmoothSurface*> surfaces_;  // one per mesh of the world; null: in another body
  OuterBoundary boundary_;
  int samples_per_pixel_;
};

}  // namespace opaline
