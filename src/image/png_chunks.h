// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a PNG is whole, before a decoder sees it: on a damaged one libpng prints to stderr by itself, takes
// a missing end for an end, and its long jump out of OpenImageIO 2.4 leaks.
#pragma once

#include <cstdint>
#include <istream>
#include <string>

namespace opaline {

/// Walks the chunks to IEND and checks each one's CRC; a byte changed or missing anywhere is found.
/// in    path: of a file that starts with the PNG signature
/// error Error{bad_input} naming the file: truncated, damaged
/// from  PNG specification (ISO/IEC 15948), sections 5.3 and annex D
void check_png_chunks(const std::string& path);
/// The same of a file's bytes in memory. name: for messages
void check_png_chunks(std::istream& file, std::uintmax_t size, const std::string& name);

}  // namespace opaline
