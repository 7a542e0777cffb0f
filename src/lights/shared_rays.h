// SPDX-License-Identifier: GPL-3.0-or-later
// Lights sharing their rays: the channels of one image.
#pragma once

#include <array>
#include <span>

#include "lights/light.h"

namespace opaline {

/// A sample of all of them at once, with the weights of sample_light.
/// in    lights: one, or up to three sharing their rays
/// out   weights: of each light; the sample's own is the first's
LightSample sample_lights(std::span<const Light> lights, const Vec3f& point, const Vec3f& normal,
                          std::array<double, 2> unit_square, int samples, std::span<float> weights);

}  // namespace opaline
