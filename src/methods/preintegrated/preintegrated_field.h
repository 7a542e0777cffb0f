// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance at hits from the light there and the curvature, as of a ball.
#pragma once

#include <array>
#include <vector>

#include "methods/preintegrated/sphere_response.h"
#include "subsurface/field.h"
#include "subsurface/render_input.h"

namespace opaline {

class PreintegratedField : public Field {
 public:
  /// medium: index into the scene's media
  PreintegratedField(const RenderInput& input, std::size_t medium);

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  float eta() const override { return eta_; }
  bool asks_irradiance() const override { return true; }
  bool reflects() const override { return true; }

 private:
  /// Surface of a mesh, blurred over the travel distance of light; at its vertices.
  struct Smooth {
    std::vector<Vec3f> normals;
    std::vector<float> curvatures;
  };
  struct Place {
    Vec3f normal;
    float curvature = 0;
  };
  Place smooth_at(const SurfacePoint& point, const Hit& hit) const;
  float thickness_along(const SurfacePoint& point, const Vec3f& towards) const;
  float curvature_through(float cosine, float curvature, float thickness) const;
  /// in    lights: sharing their rays
  void add_lights(const PointIrradianceInput& lighting, std::span<const Light> lights,
                  std::span<const Place> smooth, LeavingLight& result) const;
  /// Response of the smooth surface, plus the remaining detail.
  RgbF response(const Place& place, const Vec3f& normal, const Vec3f& towards) const;

  const RayScene& rays_;
  std::vector<SphereResponse> channels_;  // red, green, blue
  std::vector<Smooth> smooth_;            // one per mesh; empty: faceted, or another medium
  const World& world_;
  RgbF kept_;          // contrast of detail
  RgbF total_;         // exitance of a flat body over even transmitted irradiance
  float nearest_ = 0;  // distance of the nearest occluders: light spreads around nearer ones
  float eta_ = 0;
  int samples_per_pixel_;
};

}  // namespace opaline
