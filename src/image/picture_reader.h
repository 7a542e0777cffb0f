// SPDX-License-Identifier: GPL-3.0-or-later
// Image reading with OpenImageIO. The reader is a module loaded on the first use, as OpenImageIO depends on
// some 250 libraries and loading them costs as much CPU as a whole preview.
#pragma once

#include <string>

#include "opaline/image.h"

namespace opaline {

/// As read_image, for other formats than EXR.
using ReadPicture = Image (*)(const std::string& path);

}  // namespace opaline

/// Entry point of the module.
extern "C" opaline::ReadPicture opaline_picture_reader();
