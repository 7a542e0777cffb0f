// SPDX-License-Identifier: GPL-3.0-or-later
// Spectra of a scene file.
#pragma once

#include <array>
#include <string_view>

#include "spectra/spectrum.h"
#include "values/value.h"

namespace opaline {

/// Power of light, factor of light, or coefficient of a medium.
enum class Quantity { emission, factor, coefficient };

/// Keys of an object of the section "spectrum", one of them in each spectrum.
inline constexpr std::array<std::string_view, 6> kSpectrumForms{"nm",         "spectrum", "blackbody",
                                                                "illuminant", "tissue",   "powers"};
bool is_spectrum(const Node& node);
/// Keys of a light's value in photometric units, one of them.
inline constexpr std::array<std::string_view, 4> kPhotometricUnits{"lm", "cd", "lx", "nit"};

/// Reads it, times its scale.
/// error Error{bad_input} at the value: not increasing, out of range, unfit for the quantity, an unreadable file
Spectrum read_spectrum(const Value& value, Quantity quantity);

}  // namespace opaline
