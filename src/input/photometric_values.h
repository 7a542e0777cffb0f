// SPDX-License-Identifier: GPL-3.0-or-later
// Lights of a scene file in lumens, candelas, lux and nits.
#pragma once

#include "values/json_tree.h"

namespace opaline {

/// True if a light, or the surroundings, has such a value.
bool has_photometric_values(const Document& document);

/// Replaces these values by colours, or by spectra with a scale, for later reading: intensity in W/sr, irradiance in
/// W/mm^2, or radiance in W/(mm^2 sr), at 683 lm per W of luminance.
/// error Error{bad_input} at the value: a unit unfit for the quantity, a colour without luminance, wrong geometry
void resolve_photometric_values(Document& document);

}  // namespace opaline
