// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of an image file's numbers to linear Rec.709 colours. Part of the reader module
// (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <optional>
#include <string>
#include <string_view>

#include "core/rgb_primaries.h"
#include "image/texel_layout.h"
#include "image/texture_file.h"

namespace opaline {

/// Matrix from a file's primaries to Rec.709; empty: without primaries, or with those of Rec.709.
/// error Error{bad_input} naming the file: the primaries do not span a colour space
std::optional<ColorMatrix> matrix_to_rec709(const OIIO::ImageSpec& file, const std::string& path);

/// Conversions of texels to linear Rec.709, or to angles, in the order of the members.
struct TexelColors {
  bool is_premultiplied = false;         ///< colours are multiplied by alpha
  bool is_srgb = false;                  ///< encoded by IEC 61966-2-1
  std::optional<ColorMatrix> to_rec709;  ///< conversion of files with other primaries
  TextureContent content = TextureContent::data;

  TexelColors() = default;
  /// Data keep alpha and primaries of the file. A grey image has no primaries.
  /// error as matrix_to_rec709
  TexelColors(const OIIO::ImageSpec& file, std::string_view format, const TexelLayout& layout,
              TextureEncoding encoding, const std::string& path);

  bool are_plain() const { return !is_srgb && !need_texels(); }
  /// True if a conversion needs all channels of a texel.
  bool need_texels() const { return is_premultiplied || to_rec709 || are_angles(); }
  bool are_angles() const { return content > TextureContent::colors; }
  /// Type for converted values of this type: half, or float for float files.
  OIIO::TypeDesc type_for(OIIO::TypeDesc native) const;
  /// Colours in [0, 1] stay in [0, 1], even outside Rec.709's gamut.
  void apply(Texel& texel) const;
};

}  // namespace opaline
