// SPDX-License-Identifier: GPL-3.0-or-later
// Mapping of a file's values to texels. Part of the reader module (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

#include "image/color_channels.h"

namespace opaline {

/// Largest absolute value of a texel: differences of larger ones could overflow.
inline constexpr double kLargestTexel = 1e30;
inline constexpr const char* kTexelOutOfRange = "is not finite or above 1e30";

/// Texels fill the file's display window, with 0 outside its data window. They have the channels Y, Y A, R G
/// B or R G B A; a missing one of R, G and B is 0.
struct TexelLayout {
  ChannelPlaces places{};    ///< places of red, green, blue and alpha in the file
  int channels = 0;          ///< channels of a texel
  ChannelPlaces sources{};   ///< sources of a texel's channels in the file
  int begin = 0, end = 0;    ///< range of the file's channels containing them all
  bool is_windowed = false;  ///< the windows differ, or begin away from (0, 0)
  int ignored = 0;           ///< TIFF channels beside grey without a declared meaning

  /// error Error{bad_input} naming the file: as channel_places; or disjoint windows
  TexelLayout(const OIIO::ImageSpec& file, const std::string& path);

  /// True if the channels from begin to end equal a texel's.
  bool is_plain() const;
  /// Specification of texels. file: at any size
  OIIO::ImageSpec spec(const OIIO::ImageSpec& file) const;
  /// in    values: the channels from begin to end of pixels in a row, of `bytes` each
  void take(const unsigned char* values, std::size_t pixels, std::size_t bytes, unsigned char* texels) const;
};

}  // namespace opaline
