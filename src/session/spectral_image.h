// SPDX-License-Identifier: GPL-3.0-or-later
// Images at wavelengths, as colours.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {

/// Converts the layers of colours from values at three wavelengths to linear Rec.709. Variances are weighted by
/// squares, errors by magnitudes. Colours outside of Rec.709 have negative channels.
/// in    to_rgb: ThreeWavelengths::to_rgb or alone
void convert_to_rgb(Image& image, const std::array<Rgb, 3>& to_rgb);

/// Radiance at each wavelength, as layers of the image.
/// from  Fichet et al. 2021, An OpenEXR layout for spectral images: names of the channels, "S0.443,15nm"
class WavelengthLayers {
 public:
  /// Keeps the image's values at three wavelengths, before convert_to_rgb.
  void keep(const Image& image, const ThreeWavelengths& wavelengths);
  /// Adds a channel for each wavelength kept, in their order; a white light of 1 has D65's spectrum per nm with Y = 1.
  void append(Image& image) const;

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<float>> values_;  // one per wavelength
};

/// Adds the layers of colours of another converted image of the same view.
void add_colors(Image& image, const Image& other);

}  // namespace opaline
