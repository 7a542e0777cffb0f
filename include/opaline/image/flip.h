// SPDX-License-Identifier: GPL-3.0-or-later
// LDR-FLIP: visible difference when flipping between two images.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/image/metrics.h"

namespace opaline {

/// At 0.7 m from a screen 0.7 m wide with 3840 pixels, as in the paper: 0.7 x 3840 / 0.7 x pi / 180.
constexpr double flip_pixels_per_degree = 67.02064327658226;

/// LDR-FLIP of each pixel, 0 (equal) to 1, after multiplication by 2^exposure and clamping to [0, 1].
/// in    two layers of three channels, R, G, B, linear Rec.709, of the same size; pixels_per_degree > 0.
///       Non-finite values count as 0; border pixels extend beyond the border
/// out   width * height values, finite; the same for any number of threads
/// from  Andersson et al. 2020, FLIP: A Difference Evaluator for Alternating Images, sections 4.1 to 4.3;
///       within 5e-5 of its authors' program (test_flip)
std::vector<float> flip(const Layer& picture, const Layer& reference, double exposure,
                        double pixels_per_degree = flip_pixels_per_degree);

/// Exposure in stops scaling the p99 of the brightest channel over the covered pixels to 1, a typical choice
/// for viewing the reference. 0 if the p99 is not positive.
double display_exposure(const Layer& reference, const std::vector<std::uint8_t>& object);

}  // namespace opaline
