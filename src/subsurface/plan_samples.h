// SPDX-License-Identifier: GPL-3.0-or-later
// Number of samples or size of cells of a body. Each function fills its part of the body's plan and adds
// warnings.
#pragma once

#include <string>
#include <vector>

#include "bodies/plan.h"

namespace opaline {

/// Maximum cells of volume_diffusion in a body, by memory.
inline constexpr double kMostCells = 1.2e6;
/// Widest cell resolving transport, mean free paths.
double widest_cell(const Settings& settings);
/// True if such cells would exceed kMostCells. The surface is then flat on the scale of a mean free path, and
/// a radial profile is accurate.
bool is_too_large_for_cells(const Settings& settings, const BodyPlan& group);
/// True if a body with layers requires smaller cells than the limits permit.
bool is_too_large_for_layers(const Scene& scene, const World& world, double fewest, const BodyPlan& group);
/// True if light crosses the body almost without scattering, where the diffusion equation fails.
bool is_too_thin_for_cells(const BodyPlan& group);

/// Minimum samples of a body, smaller with many bodies.
double fewest_samples(std::size_t bodies);
/// Number of samples: from the settings, or by the medium's mean free path.
void choose_samples(const Scene& scene, double fewest, BodyPlan& group, std::vector<std::string>& warnings);
/// Edge of the cells of volume_diffusion.
void choose_cells(const Scene& scene, const World& world, double fewest, BodyPlan& group,
                  std::vector<std::string>& warnings);
/// Divides that edge, after choose_cells: each smaller cube cut by the surface has its samples.
void choose_cut(const Settings& settings, double fewest, BodyPlan& group, std::vector<std::string>& warnings);

}  // namespace opaline
