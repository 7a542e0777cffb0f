// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures are read by OpenImageIO, which brings some 250 libraries along: loading them costs .2 s of CPU, as
// much as a preview's samples, light and shading together. So the reader is a module, loaded when the first
// picture is read.
#pragma once

#include <string>

#include "opaline/image.h"

namespace opaline {

/// As read_image.
using ReadPicture = Image (*)(const std::string& path);

}  // namespace opaline

/// Entry point of the module.
extern "C" opaline::ReadPicture opaline_picture_reader();
