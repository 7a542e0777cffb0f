// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of the CIE.
#pragma once

#include <array>
#include <span>

namespace opaline {

inline constexpr double kFirstWavelength = 360, kLastWavelength = 830;  ///< nm, range of the observer

/// Colour matching functions x, y, z of the standard observer of 1931, 2 degrees: each nm from
/// kFirstWavelength to kLastWavelength.
std::span<const std::array<double, 3>> observer_1931();
/// Relative power of the illuminant D65, each 5 nm from 300 to 780 nm.
std::span<const double> table_d65();
/// The same of the fluorescent lamp FL2, from 380 nm on.
std::span<const double> table_fl2();

}  // namespace opaline
