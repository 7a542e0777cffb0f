// SPDX-License-Identifier: GPL-3.0-or-later
// How the fluence changes from a cell to its neighbours, and what that adds to the flow between cut cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "volume/diffusion_solver.h"

namespace opaline {

/// The fluence around a cell: least squares over its neighbours.
/// fluence: one a cell
/// out   a channel: per lattice cell
std::array<Vec3f, 3> gradient_at(const DiffusionGrid& grid, std::span<const Channels> fluence,
                                 std::uint32_t cell);

/// Adds to the problem's sources what the differences of fluence between cells misstate: across an oblique link the
/// fluence changes from one centre to the other also along the face, and nothing flows through the face for that.
/// fluence: one a cell, of the problem as it is
void add_oblique_flow(DiffusionProblem& problem, std::span<const Channels> fluence);

}  // namespace opaline
