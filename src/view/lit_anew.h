// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in lights that are all brighter or of another colour by the same factor: it is known without a ray.
#pragma once

#include <optional>

#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {

struct LitAnew {
  Image image;
  /// The channels have one factor, so it is within 1e-4 of what is rendered. Else 99 % of the values are within
  /// settings.tolerance, and the error layer, which is an estimate, within a tenth.
  bool has_one_factor = false;
};

/// The final picture of a scene made of that of another: light adds up, and channel by channel it goes with what lamps
/// emit. None where the scenes differ in more than that, or lamps by different factors.
/// in    picture: of `before`, with the layers of a method without noise that is estimated (not `direct`)
std::optional<LitAnew> lit_anew(const Image& picture, const Scene& before, const Scene& now);

}  // namespace opaline
