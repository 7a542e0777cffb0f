// SPDX-License-Identifier: GPL-3.0-or-later
// How many samples a body gets, or how large its cells are. Each fills what it decides into the body's plan, and says what
// looks wrong.
#pragma once

#include <string>
#include <vector>

#include "bodies/plan.h"

namespace opaline {

/// Most cells of volume_diffusion in a body: what memory should hold.
inline constexpr double kMostCells = 1.2e6;
/// The widest cell that tells where light goes, mean free paths.
double widest_cell(const Settings& settings);
/// True if cells as wide as that would be too many: the surface is then flat on the scale of a mean free path, and a radial
/// profile is right.
bool is_too_large_for_cells(const Settings& settings, const GroupPlan& group);
/// True if light crosses the body almost without scattering, which diffusion cannot tell.
bool is_too_thin_for_cells(const GroupPlan& group);

/// Samples that a body gets at least: fewer where bodies are many.
double fewest_samples(std::size_t bodies);
/// Samples spread over the surface: as the settings have it, or by the medium's mean free path.
void choose_samples(const Scene& scene, double fewest, GroupPlan& group, std::vector<std::string>& warnings);
/// The edge of the cells of volume_diffusion.
void choose_cells(const Scene& scene, const World& world, GroupPlan& group,
                  std::vector<std::string>& warnings);
/// After choose_cells: the parts of that edge whose cubes cut the surface into samples.
void choose_cut(const Settings& settings, double fewest, GroupPlan& group,
                std::vector<std::string>& warnings);

}  // namespace opaline
