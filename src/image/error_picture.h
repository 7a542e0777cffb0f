// SPDX-License-Identifier: GPL-3.0-or-later
// Relative errors as images: one for display, one for computation.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/compare.h"
#include "opaline/image.h"
#include "opaline/vec3.h"

namespace opaline {

/// A colour of increasing brightness from black over violet, red and orange to white, as displayed (sRGB, 0
/// to 1).
/// in    place: clamped to [0, 1]
/// from  Green 2011, A colour scheme for the display of astronomical intensity images, equation 2
RgbF brightness_ordered_colour(double place);

/// Range of error_colours, logarithmic: 0.01 % and less is black, 1 % in the middle, 100 % and more white.
constexpr double darkest_error = 1e-4, brightest_error = 1;

/// R, G, B for write_png at exposure 0: each pixel's largest error over the channels as a colour. Grey for
/// uncovered pixels, green for covered pixels with a non-finite value.
/// in    errors of `layer`'s pixels; object: a flag per pixel
Image error_colours(const RelativeErrors& errors, const Layer& layer,
                    const std::vector<std::uint8_t>& object);

/// The signed errors in the channels of the layer, by the last part of their names (R, G, B); 0 in pixels not
/// compared.
Image signed_errors(const RelativeErrors& errors, const Layer& layer);

}  // namespace opaline
