// SPDX-License-Identifier: GPL-3.0-or-later
// Absorption of living tissue by its pigments.
#pragma once

#include "spectra/spectrum.h"

namespace opaline {

/// Fractions of the volume are in [0, 1], with a sum of at most 1.
struct Tissue {
  double melanin = 0;        ///< fraction of the volume: skin .01 to .4
  double eumelanin = .7;     ///< brown fraction of the melanin; the rest is red (pheomelanin)
  double blood = 0;          ///< fraction of the volume: skin .002 to .07
  double oxygenation = .75;  ///< fraction of the haemoglobin with oxygen
};

/// sigma_a at each nm, 1/mm.
Spectrum tissue_absorption(const Tissue& tissue);

}  // namespace opaline
