// SPDX-License-Identifier: GPL-3.0-or-later
// Camera rays by the estimated error of their pixels.
#pragma once

#include "render/render.h"

namespace opaline {

inline constexpr int kFewestAdaptiveRays = 8, kMostAdaptiveRays = 1024;  ///< per pixel

/// True if the image has camera rays until Settings::until_error; `direct` and `volume` use it for other samples.
bool has_adaptive_rays(const Scene& scene);

/// Memory of render_adaptive beyond render(), bytes.
std::size_t adaptive_bytes(const Film& film);

/// As render(), with numbers of camera rays by pixel: rounds of rays, each doubling those of its pixels, until the RelativeNoise of
/// R, G, B over all pixels with a surface is at most settings.until_error. The pixels with the largest decrease of the
/// squared noise per ray continue. The image depends neither on the number of threads nor on film.samples_per_pixel.
///
/// The two halves of the rays estimate the standard error of a pixel. Halves are too noisy to choose single pixels: halves
/// may agree by chance. Within a tile, the variance over the rays of each pixel distributes the sum of the estimates; the
/// pixels around add the variance of features between its rays. The estimate exceeds the error at edges, as halves of
/// even samples are less even than the whole.
/// in    as render; with RenderInput::adaptive_rays, these many rays
/// out   adaptive; layer `error`: antialiasing included
RenderResult render_adaptive(const RenderInput& input);

}  // namespace opaline
