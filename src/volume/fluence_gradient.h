// SPDX-License-Identifier: GPL-3.0-or-later
// Gradient of the fluence, and its correction to the flux between cut cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "volume/diffusion_solver.h"

namespace opaline {

/// Gradient of the fluence at a cell: least squares over its neighbours.
/// fluence: one per cell
/// out   per channel and lattice cell
std::array<Vec3f, 3> gradient_at(const DiffusionGrid& grid, std::span<const Channels> fluence,
                                 std::uint32_t cell);

/// Corrects the sources for oblique links: the fluence difference of two offset centres includes the change
/// along their face, which causes no flux through it.
/// fluence: one per cell, of the uncorrected problem
void add_oblique_flow(DiffusionProblem& problem, std::span<const Channels> fluence);

}  // namespace opaline
