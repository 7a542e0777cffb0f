// SPDX-License-Identifier: GPL-3.0-or-later
// Which groups have their exitance evaluated all over, ahead of the picture.
#pragma once

#include <span>

#include "opaline/render/precompute.h"

namespace opaline {

/// Makes the surface caches that the settings ask for, or, if they leave it open, those of groups that the
/// camera sees at many more points than a cache has places. True if it made any. Crops do not count: their
/// bytes are the whole picture's.
bool make_surface_caches(const PrecomputeInput& input, std::span<TranslucentGroup> groups);

}  // namespace opaline
