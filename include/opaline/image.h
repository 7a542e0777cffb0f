// SPDX-License-Identifier: GPL-3.0-or-later
// Images as named float layers, and their files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "opaline/enumerations.h"
#include "opaline/zeroed_array.h"

namespace opaline {

/// width x height pixels, row by row from the top left, channels interleaved.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< "R", "G", "B", "diffuse.R", "N.X", "Z", ...
  ZeroedArray<float> pixels;          ///< width * height * channels.size() values
  /// Text for the file's header, such as {"opaline:seed", "0"}.
  std::vector<std::pair<std::string, std::string>> metadata;
  /// Position of a crop in the full image: x0, y0 and the full width and height.
  int crop_x = 0, crop_y = 0, full_width = 0, full_height = 0;
  double pixel_aspect = 1;  ///< width of a pixel over its height
};

struct WriteReport {
  std::size_t non_finite = 0;     ///< NaN or infinite values; written as 0
  std::size_t half_overflow = 0;  ///< finite values above 65504, the largest half; written as 65504
};

/// Writes an EXR with all layers and metadata; the bytes depend on the image alone (no time stamp). Colour
/// and N in half on request; P, Z, irradiance, variance and Cryptomatte's channels always in float.
/// error Error{run_failed} naming the file: not writable, disk full; the old file remains unchanged
WriteReport write_exr(const std::string& path, const Image& image, bool half);

/// Writes R, G, B as an 8-bit sRGB PNG after multiplication by 2^exposure and the view transform.
/// error as write_exr
void write_png(const std::string& path, const Image& image, double exposure,
               ViewTransform view = ViewTransform::srgb);

/// Reads an EXR, HDR (Radiance) or PNG. Colours become linear Rec.709: PNGs from sRGB, EXRs with AP1
/// chromaticities from ACEScg.
/// error Error{bad_input} naming the file: missing, truncated, not an image
Image read_image(const std::string& path);

}  // namespace opaline
