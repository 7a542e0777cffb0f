// SPDX-License-Identifier: GPL-3.0-or-later
// Colours and coefficients of a scene file at wavelengths.
#pragma once

#include <optional>

#include "opaline/scene.h"
#include "values/json_tree.h"

namespace opaline {

/// Number of wavelengths for a scene's colours: film.wavelengths, or the fewest with which each light, each
/// surface in each light, and each medium have their colour within 1 % of the brightest channel. None: red,
/// green and blue, of a scene with neither.
/// error Error{bad_input} at a spectrum: not increasing, out of range, an unreadable file
std::optional<int> wavelengths_of(const Document& document);

/// Replaces spectra, and colours in red, green and blue, by the values at three wavelengths; for later reading.
/// Lights are relative to D65.
/// error as wavelengths_of
void resolve_spectra(Document& document, const ThreeWavelengths& wavelengths);

/// A preset's coefficients at the wavelengths of its document; unchanged without.
Rgb coefficients_at(const Rgb& rgb, const ThreeWavelengths* wavelengths);

}  // namespace opaline
