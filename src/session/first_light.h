// SPDX-License-Identifier: GPL-3.0-or-later
// Coarse preview of an image.
#pragma once

#include "bodies/body.h"
#include "render/render.h"

namespace opaline {

/// The image from one camera ray per stride x stride pixels, interpolated.
/// in    stride >= 1; the scene's method is not direct
/// out   R G B A of the full resolution, black in uncovered pixels
Image coarse_picture(const RenderInput& input, int stride);

/// The image from a sixteenth of the plan's samples, placed quickly, and one camera ray for 8 x 8 pixels or
/// more: within a tenth of the CPU time of samples and image (test_first_light). `direct` uses the
/// hierarchical preview.
/// out   as coarse_picture
Image first_light(const PrecomputeInput& input);

}  // namespace opaline
