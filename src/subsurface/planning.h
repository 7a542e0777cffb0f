// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs and results of planning one body.
#pragma once

#include <span>
#include <string>

#include "bodies/plan.h"
#include "lights/light.h"

namespace opaline {

/// Properties of the lights determining costs.
struct Lighting {
  double lights = 0;
  double extended_lights = 0;  ///< those that are neither points nor directions
  double rays = 0;             ///< shadow rays from a point
  double directions = 0;       ///< directions of incident light at a sample of volume_diffusion
};
Lighting lighting_of(const Scene& scene);

struct PlanningInput {
  const Scene& scene;
  const World& world;
  std::span<const Light> lights;  ///< recentred
  double fewest_samples;          ///< fewest samples of a body
  std::span<const BodyPlan> reference =
      {};  ///< bodies of another frame; bodies of the same names use their methods
};

/// Expected memory of a body, bytes.
struct BodyMemory {
  std::size_t kept = 0;
  std::size_t caches = 0;  ///< surface caches, made after light between shapes is gathered
  double temporary = 0;    ///< while the body is prepared
  /// Samples evaluated at the hits, with memory proportional to the image.
  std::size_t evaluated_samples = 0;
};

/// Fraction of the area in triangles far longer than high. Samples there stand in lines, each in its own
/// block of the sampling grid.
double needle_fraction(const World& world, const BodyPlan& body);

/// "irradiance: 2 lights, ..."
std::string irradiance_stage(const Scene& scene, std::span<const Light> lights);

}  // namespace opaline
