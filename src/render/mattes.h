// SPDX-License-Identifier: GPL-3.0-or-later
// Cryptomatte: layers by which a compositor selects objects and materials.
#pragma once

#include <string_view>

#include "render/render.h"

namespace opaline {

/// The number standing for a name, as the bits of a float that is neither denormal, infinite nor NaN.
/// from  Cryptomatte specification 1.2.0: MurmurHash3 (x86, 32 bits, seed 0), uint32_to_float32
float matte_id(std::string_view name);

/// Names of a pixel by the fraction of it that they cover, as many as are kept.
inline constexpr std::size_t kMatteRanks = 6;

/// Appends the layers CryptoObject and CryptoMaterial to a picture, and their metadata. An object is a shape. Its material
/// is its medium; opaque shapes are materials of their own. Shares of a pixel are those of its camera rays, which are
/// traced again: 24 floats and one more ray of each sample are what it costs.
/// in    picture: of the input's scene
/// from  Friedman & Jones 2015, Fully Automatic ID Mattes with Support for Motion Blur and Transparency; Cryptomatte
///       specification 1.2.0
void add_mattes(const RenderInput& input, Image& picture);

}  // namespace opaline
