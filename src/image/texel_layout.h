// SPDX-License-Identifier: GPL-3.0-or-later
// Where the texels of a texture lie among the values of a file. Of the module (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

#include "image/color_channels.h"

namespace opaline {

/// Largest absolute value of a texel: slopes between larger ones would not be finite.
inline constexpr double kLargestTexel = 1e30;
inline constexpr const char* kTexelOutOfRange = "has a texel that is not finite or above 1e30";

/// Texels fill the file's display window; outside of its data window they are 0. They have the channels Y, Y A, R G B or
/// R G B A; one of R, G and B that the file lacks is 0.
struct TexelLayout {
  ChannelPlaces places{};    ///< places of red, green, blue and alpha in the file
  int channels = 0;          ///< channels of a texel
  ChannelPlaces sources{};   ///< sources of a texel's channels in the file
  int begin = 0, end = 0;    ///< the channels of the file that hold them all
  bool is_windowed = false;  ///< the two windows differ
  int ignored = 0;           ///< channels beside grey whose meaning a TIFF file does not state

  /// error Error{bad_input} naming the file: as channel_places; the windows have no pixel in common
  TexelLayout(const OIIO::ImageSpec& file, const std::string& path);

  /// True if the channels from begin to end are a texel's as they stand.
  bool is_plain() const;
  /// Specification of texels. file: at any size
  OIIO::ImageSpec spec(const OIIO::ImageSpec& file) const;
  /// in    values: the channels from begin to end of pixels in a row, of `bytes` each
  void take(const unsigned char* values, std::size_t pixels, std::size_t bytes, unsigned char* texels) const;
};

}  // namespace opaline
