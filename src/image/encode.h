// SPDX-License-Identifier: GPL-3.0-or-later
// One way for every picture to reach the disk: OpenImageIO encodes, we write, nothing is lost on the way.
#pragma once

#include <OpenImageIO/imageio.h>

#include <functional>
#include <string>

namespace opaline {

/// Fills pixels [first, first + count) rows of the picture, in the spec's channels; returns where they are.
using FillRows = std::function<const void*(int first, int count)>;

/// Encodes a picture strip by strip and puts it in place of `path` when all of it is on the disk.
/// in    format: "exr" or "png"; type: of the values that `rows` returns
/// error Error{run_failed} naming the file: not writable, disk full; the old file is left as it was
void encode(const std::string& path, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
            const FillRows& rows);

/// OpenImageIO's message on one line.
std::string one_line(std::string message);

}  // namespace opaline
