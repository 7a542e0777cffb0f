// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic choice of the radial profile of a medium in a body, and its expected error against random walks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bodies/plan.h"
#include "geometry/world.h"

namespace opaline {

/// Shape properties determining the model.
struct BodyShape {
  double area = 0;       ///< mm^2
  double thickness = 0;  ///< mean, mm: twice the volume over the area; 0 if a mesh is open
  /// Mean squared cosine between the normals of two points of the surface: 1 of a thin plate, 1/2 of a rod,
  /// 1/3 of a sphere or a cube.
  double alignment = 0;
  std::vector<double> local = {};  ///< thickness at places of equal area, mm; empty: the mean everywhere

  /// Thickness of a square plate with this area and mean thickness, mm: its rim is part of the area.
  double plate_thickness() const;
  bool is_flat() const;
};

/// Chosen profile, and the reason.
std::string model_text(const BodyModel& model);
/// Text of the expected model error of a method; empty: unknown, or none.
/// reenters: true if the method's image includes light entering the body again
std::string model_error_text(const BodyModel& model, Method method, bool reenters);

/// Derived in src/diffusion/README.md; bench_volume_models measures the figures.
BodyModel choose_model(const Medium& medium, const BodyShape& shape);

/// Chooses the open profiles (Medium::profile is none) of a scene's media by their bodies. A medium with
/// different choices becomes several media of the same name.
/// reference: bodies of another frame; bodies of the same names use their profiles
void choose_models(Scene& scene, const World& world, std::span<const BodyPlan> reference = {});

}  // namespace opaline
