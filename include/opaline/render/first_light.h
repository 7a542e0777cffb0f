// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture will look like, long before it is there.
#pragma once

#include "opaline/render/precompute.h"
#include "opaline/render/render.h"

namespace opaline {

/// In each direction one pixel of this many stands for them all in a first look: at least 8, more where that
/// leaves a picture of more than 48 x 48.
int first_light_stride(const Film& film);

/// The picture from one camera ray for each stride x stride pixels, interpolated between them.
/// in    stride >= 1; the scene's method is not direct
/// out   R G B A of the size of the picture, black where nothing is
Image coarse_picture(const RenderInput& input, int stride);

/// The picture from a sixteenth of the plan's samples, placed at next to no cost, and every
/// first_light_stride-th pixel: within a tenth of the CPU time of samples and picture (test_first_light).
/// `direct` has the hierarchical one.
/// out   as coarse_picture
Image first_light(const PrecomputeInput& input);

}  // namespace opaline
