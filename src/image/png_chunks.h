// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of a PNG. Whether it is whole is checked before a decoder sees it: on a damaged one libpng prints to stderr by
// itself, takes a missing end for an end, and its long jump out of OpenImageIO 2.4 leaks. Text is added after an encoder
// made it: libpng's simple encoder writes none.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "image/picture_bytes.h"

namespace opaline {

/// Walks the chunks to IEND and checks each one's CRC; a byte changed or missing anywhere is found.
/// in    bytes: start with the PNG signature; path: for messages
/// error Error{bad_input} naming the file: truncated, damaged
/// from  PNG specification (ISO/IEC 15948), sections 5.3 and annex D
void check_png_chunks(const PictureBytes& bytes, const std::string& path);

/// A PNG with texts behind its header, each a chunk iTXt.
/// in    bytes: a whole PNG; texts: keywords of 1 to 79 ASCII characters, and UTF-8
/// from  PNG specification, section 11.3.4.5
std::string with_png_texts(const std::string& bytes,
                           std::span<const std::pair<std::string, std::string>> texts);

}  // namespace opaline
