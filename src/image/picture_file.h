// SPDX-License-Identifier: GPL-3.0-or-later
// Image files opened by OpenImageIO, after checks before decoding. Part of the reader module
// (picture_reader.h).
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "image/picture_bytes.h"

namespace opaline {

/// An image opened by OpenImageIO, for reading without premultiplied alpha.
struct OpenPicture {
  std::string_view format;  ///< "exr", "hdr", "png", "jpeg", "tiff" or "webp"
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  OIIO::ImageInput::unique_ptr input;  ///< destroyed first
};

/// Opens a source in one of the formats; must not outlive it. Memory is bounded by the file's length, as a
/// damaged header may have any size.
/// error Error{bad_input} naming the file: missing, not a regular file, another format, deep, too large,
/// integer colours in an EXR
OpenPicture open_picture(const PictureSource& source, std::span<const std::string_view> formats);

/// Checks a PNG's chunks, a JPEG's end and a TIFF's strips, ignored by their decoders.
/// error Error{bad_input} naming the file: truncated, damaged
void check_is_whole(const PictureSource& source);

/// The pending message; not fetched, OpenImageIO 2.5 and later print it at exit.
std::string complaint_of(const OIIO::ImageInput* input);

}  // namespace opaline
