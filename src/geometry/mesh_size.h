// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a mesh file's length is one to be read into memory.
#pragma once

#include <cstdint>
#include <string>

namespace opaline {

/// in    path: of a file that can be opened; size: its length, bytes
/// error Error{bad_input} naming it: longer than the memory that is left, or binary STL of more than twice
/// the
///       length of the triangles that its header names (and 1 MiB)
void check_mesh_size(const std::string& path, std::uintmax_t size);

}  // namespace opaline
