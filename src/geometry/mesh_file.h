// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files: format from the name, and contents as a hash, without reading the mesh.
#pragma once

#include <string>

namespace opaline {

/// True for a file name with a mesh format's extension, in upper or lower case.
bool is_mesh_file_name(const std::string& path);

/// Raw bytes of a mesh file.
/// error Error naming the file: missing, with the nearest name in its folder; not a file, empty, not readable
std::string read_mesh_bytes(const std::string& path);

/// Contents of a mesh file: its bytes, or a hash of its bytes and of the files it refers to.
/// error as read_mesh_bytes, and for glTF as reading it
std::string mesh_contents(const std::string& path);

/// True for the file's bytes alone.
bool names_no_files(const std::string& path);

}  // namespace opaline
