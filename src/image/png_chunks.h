// SPDX-License-Identifier: GPL-3.0-or-later
// PNG chunk structure. Checked before decoding: on damaged files, libpng prints to stderr, accepts a missing
// end, and leaks by a long jump out of OpenImageIO 2.4. Text chunks are added after encoding, as libpng's
// simple encoder writes none.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "image/picture_bytes.h"

namespace opaline {

/// Checks the CRC of each chunk up to IEND; detects any changed or missing byte.
/// in    bytes: start with the PNG signature; path: for messages
/// error Error{bad_input} naming the file: truncated, damaged
/// from  PNG specification (ISO/IEC 15948), sections 5.3 and annex D
void check_png_chunks(const PictureBytes& bytes, const std::string& path);

/// A PNG with texts after its header, one iTXt chunk each.
/// in    bytes: a whole PNG; texts: keywords of 1 to 79 ASCII characters, and UTF-8
/// from  PNG specification, section 11.3.4.5
std::string with_png_texts(const std::string& bytes,
                           std::span<const std::pair<std::string, std::string>> texts);

}  // namespace opaline
