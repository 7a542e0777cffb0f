// SPDX-License-Identifier: GPL-3.0-or-later
// Cryptomatte: layers for selecting objects and materials in a compositor.
#pragma once

#include <string_view>

#include "render/render.h"

namespace opaline {

/// Hash of a name as the bits of a float, excluding denormals, infinities and NaNs.
/// from  Cryptomatte specification 1.2.0: MurmurHash3 (x86, 32 bits, seed 0), uint32_to_float32
float matte_id(std::string_view name);

/// Number of names stored per pixel, by coverage.
inline constexpr std::size_t kMatteRanks = 6;

/// Appends the layers CryptoObject and CryptoMaterial to an image, and their metadata. An object is a shape.
/// Its material is its medium; opaque shapes are materials of their own. Traces the camera rays again for
/// their coverage; costs 24 floats per pixel.
/// in    picture: of the input's scene, and of its RenderInput::adaptive_rays
/// from  Friedman & Jones 2015, Fully Automatic ID Mattes with Support for Motion Blur and Transparency;
///       Cryptomatte specification 1.2.0
void add_mattes(const RenderInput& input, Image& picture);

}  // namespace opaline
