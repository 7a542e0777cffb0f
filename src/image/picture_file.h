// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files as OpenImageIO opens them, after what can be checked before they are decoded. Of the module
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

/// A picture that OpenImageIO has opened, to be read with alpha not multiplied in.
struct OpenPicture {
  std::string_view format;  ///< "exr", "hdr", "png", "jpeg" or "tiff"
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  OIIO::ImageInput::unique_ptr input;  ///< destroyed first
};

/// Opens a source, which outlives it, if it is of one of the formats. Memory stays bounded by the file's own length: a
/// damaged header can claim any size.
/// error Error{bad_input} naming the file: missing, no regular file, not of the formats, deep, too large
OpenPicture open_picture(const PictureSource& source, std::span<const std::string_view> formats);

/// Checks a PNG's chunks and a JPEG's end, which their decoders do not.
/// error Error{bad_input} naming the file: truncated, damaged
void check_is_whole(const PictureSource& source);

/// The pending message; not fetched, OpenImageIO 2.5 and later print it at exit.
std::string complaint_of(const OIIO::ImageInput* input);

}  // namespace opaline
