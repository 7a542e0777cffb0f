// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the completeness of an OpenEXR file's chunks. OpenEXR 3.1 returns uninitialised memory for missing
// pixels.
#pragma once

#include <string>

namespace opaline {

/// Checks the first part of a file: every uncompressed or run-length encoded chunk; of ZIP chunks, protected
/// by checksums, the first and the last. No chunk may be empty. The decoders of other compressions make the
/// same check.
/// error Error{bad_input} naming the file: truncated, damaged
/// from  the OpenEXR file layout (openexr.com/en/latest/OpenEXRFileLayout.html)
void check_exr_chunks(const std::string& path);

/// A complaint of OpenEXR without its sentences naming the file.
std::string without_name(std::string complaint, const std::string& path);

}  // namespace opaline
