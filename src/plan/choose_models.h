// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic choice of the radial profile of a medium in a body, and its expected error against random walks.
#pragma once

#include <span>
#include <string>

#include "bodies/plan.h"
#include "geometry/world.h"

namespace opaline {

/// Properties of a body's shape that decide the model.
struct BodyShape {
  double area = 0;       ///< mm^2
  double thickness = 0;  ///< mean, mm: twice the volume over the area; 0 if a mesh is open
  /// Mean squared cosine between the normals of two points of the surface: 1 of a thin plate, 1/2 of a rod, 1/3 of a
  /// sphere or a cube.
  double alignment = 0;

  /// Plate thickness of a square plate of this area and mean thickness, mm: its rim is part of the area.
  double plate_thickness() const;
  bool is_flat() const;
};

/// Chosen profile, and the reason.
std::string model_text(const BodyModel& model);
/// Text of the expected model error of a method; empty: unknown, or none.
std::string model_error_text(const BodyModel& model, Method method);

/// The rule and its figures are derived in src/diffusion/README.md; bench_volume_models measures them.
BodyModel choose_model(const Medium& medium, const BodyShape& shape);

/// Gives the media of a scene leaving their profile open (Medium::profile is none) that of the body they are in. A
/// medium of bodies that ask for different ones becomes several media of its name.
/// reference: bodies of another frame, whose profiles those of the same names take over
void choose_models(Scene& scene, const World& world, std::span<const GroupPlan> reference = {});

}  // namespace opaline
