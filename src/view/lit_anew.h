// SPDX-License-Identifier: GPL-3.0-or-later
// Image under lights scaled by one factor, without tracing rays.
#pragma once

#include <optional>

#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {

struct LitAnew {
  Image image;
  /// True if all channels have one factor: within 1e-4 of a new render. Otherwise 99 % of the values are
  /// within settings.tolerance, and the error layer, an estimate, within a tenth.
  bool has_one_factor = false;
};

/// Final image of a scene from that of another: light is additive, and each channel is linear in the lights'
/// emission. None if the scenes differ in other ways, or the lights by different factors.
/// in    picture: of `before`, with the layers of a method without noise estimate (not `direct`)
std::optional<LitAnew> lit_anew(const Image& picture, const Scene& before, const Scene& now);

}  // namespace opaline
