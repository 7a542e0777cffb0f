// SPDX-License-Identifier: GPL-3.0-or-later
// What picture files tell before they are decoded, and how OpenImageIO complains. Of the module (picture_reader.h).
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace opaline {

/// Enough of a file to know its format.
/// error Error{bad_input} naming the file: missing, not a file
std::string first_bytes(const std::string& path);

/// "exr", "hdr", "png", "jpeg" or "tiff" by the first bytes; null: none of them. OpenImageIO would try every format it
/// knows, and finds a Targa in noise.
const char* picture_format(std::string_view start);

/// A damaged header can claim any size: memory stays bounded by the file's own.
/// error Error{bad_input} naming the file
void check_picture_size(const std::string& path, const OIIO::ImageSpec& spec, std::string_view format,
                        std::uintmax_t file_size);

/// The pending message; not fetched, OpenImageIO 2.5 and later print it at exit.
std::string complaint_of(const OIIO::ImageInput* input);

}  // namespace opaline
