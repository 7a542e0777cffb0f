// SPDX-License-Identifier: GPL-3.0-or-later
// EXR reading with OpenEXR alone, without loading the reader module (picture_reader.h).
#pragma once

#include <cstdint>
#include <string>

#include "opaline/image.h"

namespace opaline {

/// The first part of an EXR, scan lines or the largest level of tiles, as read_image.
/// in    bytes: length of the file
/// error as read_image; deep, subsampled channels, integer colours
Image read_exr(const std::string& path, std::uintmax_t bytes);

}  // namespace opaline
