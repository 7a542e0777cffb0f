// SPDX-License-Identifier: GPL-3.0-or-later
// Images at wavelengths, as colours.
#pragma once

#include <array>

#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {

/// Converts the layers of colours from values at three wavelengths to linear Rec.709. Variances are weighted by
/// squares, errors by magnitudes. Colours outside of Rec.709 have negative channels.
/// in    to_rgb: ThreeWavelengths::to_rgb or alone
void convert_to_rgb(Image& image, const std::array<Rgb, 3>& to_rgb);

/// Adds the layers of colours of another converted image of the same view.
void add_colors(Image& image, const Image& other);

}  // namespace opaline
