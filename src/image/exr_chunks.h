// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the chunks of an OpenEXR file hold all of their pixels. Where one decodes to fewer, OpenEXR 3.1 returns what memory
// held before.
#pragma once

#include <string>

namespace opaline {

/// Checks the first part of a file: all chunks that are not compressed or run-length encoded; of those by ZIP, which have
/// checksums, the first and the last. Decoders of other compressions check this themselves.
/// error Error{bad_input} naming the file: truncated, damaged
/// from  the OpenEXR file layout (openexr.com/en/latest/OpenEXRFileLayout.html)
void check_exr_chunks(const std::string& path);

}  // namespace opaline
