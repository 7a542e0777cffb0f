// SPDX-License-Identifier: GPL-3.0-or-later
// From the numbers of an image file to linear Rec.709 colours. Part of the module (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <optional>
#include <string>
#include <string_view>

#include "core/rgb_primaries.h"
#include "image/texel_layout.h"
#include "image/texture_file.h"

namespace opaline {

/// Matrix from the primaries that a file states to Rec.709; empty: it states none, or those of Rec.709.
/// error Error{bad_input} naming the file: the primaries span no colour space
std::optional<ColorMatrix> matrix_to_rec709(const OIIO::ImageSpec& file, const std::string& path);

/// Changes that make texels linear Rec.709 colours, in the order of the members.
struct TexelColors {
  bool is_premultiplied = false;         ///< colours are multiplied by alpha
  bool is_srgb = false;                  ///< encoded by IEC 61966-2-1
  std::optional<ColorMatrix> to_rec709;  ///< conversion of files with other primaries

  TexelColors() = default;
  /// Data keep alpha and primaries as the file has them. A grey image has no primaries.
  /// error as matrix_to_rec709
  TexelColors(const OIIO::ImageSpec& file, std::string_view format, const TexelLayout& layout,
              TextureEncoding encoding, const std::string& path);

  bool are_plain() const { return !is_premultiplied && !is_srgb && !to_rec709; }
  /// Type that holds changed values of this type: halves, floats where the file has them.
  OIIO::TypeDesc type_for(OIIO::TypeDesc native) const;
  /// Colours of 0 to 1 stay between 0 and 1, also where Rec.709 does not hold them.
  void apply(Texel& texel) const;
};

}  // namespace opaline
