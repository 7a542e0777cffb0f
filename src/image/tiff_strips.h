// SPDX-License-Identifier: GPL-3.0-or-later
// Places of the pixels in a TIFF. Checked before decoding: OpenImageIO reads missing uncompressed pixels as
// black.
#pragma once

#include <string>

#include "image/picture_bytes.h"

namespace opaline {

/// Checks the ends of all strips or tiles of the first image.
/// in    bytes: start with the signature of TIFF or BigTIFF; path: for messages
/// error Error{bad_input} naming the file: truncated
/// from  TIFF 6.0, sections 2, 3 and 15; BigTIFF
void check_tiff_strips(const PictureBytes& bytes, const std::string& path);

}  // namespace opaline
