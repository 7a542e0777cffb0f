// SPDX-License-Identifier: GPL-3.0-or-later
// The header of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace opaline {

enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t byte_size(PlyScalar type);
inline bool is_floating(PlyScalar type) {
  return type >= PlyScalar::float32;
}

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::float32;  ///< type of the value, or of each entry of a list
  bool is_list = false;
  PlyScalar count_type = PlyScalar::uint8;  ///< count type of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::string texture;   ///< name in a comment "TextureFile" (MeshLab); empty: none
  std::size_t size = 0;  ///< bytes, up to and with the newline after end_header
  int lines = 0;
};

/// error Error{bad_input} with the line
PlyHeader read_ply_header(const std::string& path, const std::string& bytes);

}  // namespace opaline
