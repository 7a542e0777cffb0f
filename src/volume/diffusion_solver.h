// SPDX-License-Identifier: GPL-3.0-or-later
// Steady diffusion on a grid, all colour channels at once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "opaline/monitor.h"
#include "volume/diffusion_grid.h"

namespace opaline {

/// R G B and an unused fourth, in a vector register; extension of GCC and Clang.
struct Channels {
  typedef float Four __attribute__((vector_size(16)));
  Four c{};
};

/// For each cell: sum over links of diffusivity x conductance x (own - other's fluence) + loss x fluence =
/// source.
struct DiffusionProblem {
  const DiffusionGrid& grid;
  std::array<float, 3> diffusivity{};
  std::vector<Channels> loss;                ///< one per cell, >= 0
  std::vector<Channels> source;              ///< one per cell
  std::vector<Channels> diffusivities = {};  ///< one per cell, > 0; empty: `diffusivity` everywhere

  /// Coefficient between two cells' centres: half of the distance belongs to each, by their sizes.
  Channels between(std::uint32_t a, std::uint32_t b) const;
};

struct DiffusionSolution {
  std::vector<Channels> fluence;  ///< one per cell
  int iterations = 0;
};

/// Conjugate gradients with a Jacobi preconditioner; few iterations suffice on cells growing inwards.
/// in    start: initial guess, empty or one per cell
///       tolerance: of the residual, in the norm of the inverse diagonal, over that of the source
/// out   losses and sources balance to rounding; the same bits for any number of threads
/// error Error{interrupted}
DiffusionSolution solve_diffusion(const DiffusionProblem& problem, double tolerance,
                                  std::vector<Channels> start = {}, Monitor* monitor = nullptr);

}  // namespace opaline
