// SPDX-License-Identifier: GPL-3.0-or-later
// Coarse preview of an image.
#pragma once

#include "bodies/body.h"
#include "render/render.h"

namespace opaline {

/// The picture from one camera ray for each stride x stride pixels, interpolated between them.
/// in    stride >= 1; the scene's method is not direct
/// out   R G B A of the size of the picture, black where nothing is
Image coarse_picture(const RenderInput& input, int stride);

/// The image from a sixteenth of the plan's samples, placed at next to no cost, and one camera ray for 8 x 8 pixels or
/// more: within a tenth of the CPU time of samples and image (test_first_light). `direct` has the hierarchical one.
/// out   as coarse_picture
Image first_light(const PrecomputeInput& input);

}  // namespace opaline
