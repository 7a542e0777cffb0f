// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that the chunks of an OpenEXR file hold all of their pixels. OpenEXR 3.1 returns uninitialised memory for the missing
// ones.
#pragma once

#include <string>

namespace opaline {

/// Checks the first part of a file: every uncompressed or run-length encoded chunk; of ZIP chunks, which have checksums, the
/// first and the last. No chunk may be empty. The decoders of other compressions make the same check.
/// error Error{bad_input} naming the file: truncated, damaged
/// from  the OpenEXR file layout (openexr.com/en/latest/OpenEXRFileLayout.html)
void check_exr_chunks(const std::string& path);

}  // namespace opaline
