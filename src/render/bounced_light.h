// SPDX-License-Identifier: GPL-3.0-or-later
// Light that surfaces send to other surfaces.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/camera_rays.h"
#include "render/shade.h"

namespace opaline {

/// What points gather, by rays over the hemisphere, from surfaces that are lit by the scene's lights.
struct GatherInput {
  const RayScene& rays;
  const Shader& shader;
  std::span<const SurfacePoint> points;
  std::span<const std::uint64_t> keys;  ///< one a point: chooses its random numbers
  float eta = 0;                        ///< of the boundary that light enters through; 0: none
  int rays_each = 64;
  std::uint64_t seed = 0;
};

/// Light that reaches a point from a surface: index of the point, unit direction towards the surface, irradiance of what
/// comes through the boundary where there is one.
using UseOfGathered = std::function<void(std::size_t point, const Vec3f& towards, const RgbF& irradiance)>;

void for_each_gathered(const GatherInput& input, const UseOfGathered& use);

/// Their sums, one a point, W/mm^2.
std::vector<RgbF> gathered_irradiance(const GatherInput& input);

/// The same at what a camera sees at 64 places along its picture's longer side. Where bodies' trees hold what bounced to
/// them, so does what they send here, a second bounce: a Session's do not while it gathers.
/// from  Ward, Rubinstein & Clear 1988
class BouncedPlaces {
 public:
  /// shader: without bounced light
  BouncedPlaces(const RenderInput& input, const Shader& shader);

  /// Between places on the plane of the point; none where no place stands for it.
  std::optional<RgbF> at(const SurfacePoint& point, float eta) const;

 private:
  struct Place {
    bool is_there = false;
    SurfacePoint point;
    RgbF irradiance;
    float eta = 0;
    float spacing = 0;  // to the next ones, across the view
  };
  void gather(const RenderInput& input, const Shader& shader, std::span<const TracedRay> rays);

  CameraRays camera_;
  int step_;  // pixels from one place to the next
  int columns_, rows_;
  std::vector<Place> places_;  // row after row
};

/// At the hits of a picture: by RenderInput::bounced, or places of its own. Hits that no place stands for gather for
/// themselves.
class BouncedLight {
 public:
  /// shader: without bounced light; both must outlive it
  BouncedLight(const RenderInput& input, const Shader& shader);

  /// One a hit, W/mm^2.
  std::vector<RgbF> at(const SurfaceHits& hits, float eta) const;

 private:
  const RenderInput& input_;
  const Shader& shader_;
  std::shared_ptr<const BouncedPlaces> places_;
};

}  // namespace opaline
