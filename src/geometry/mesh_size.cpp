// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_size.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "opaline/core/error.h"
#include "opaline/core/machine_memory.h"

namespace opaline {
namespace {

/// Bytes that a binary STL file's header accounts for; 0: text, or too short to tell.
std::uintmax_t binary_stl_size(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 84> head{};
  if (!file.read(head.data(), head.size())) return 0;
  const std::string_view text(head.data(), head.size());
  if (text.starts_with("solid") && text.find('\0') == text.npos) return 0;
  std::uintmax_t triangles = 0;
  for (std::size_t i = 4; i-- > 0;) triangles = triangles << 8 | std::uint8_t(head[80 + i]);
  return head.size() + 50 * triangles;
}

}  // namespace

void check_mesh_size(const std::string& path, std::uintmax_t size) {
  constexpr std::uintmax_t kSpare = 1 << 20;  // programs append notes of their own
  const std::string extension = std::filesystem::path(path).extension().string();
  const std::uintmax_t told = extension == ".stl" || extension == ".STL" ? binary_stl_size(path) : 0;
  if (told > 0 && size > 2 * told + kSpare)
    throw bad_file(path, "the file is far longer than its header says", std::to_string(told) + " bytes",
                   std::to_string(size));
  if (const std::size_t memory = available_memory(); size > memory)
    throw bad_file(path, "the mesh file does not fit into memory", std::to_string(memory) + " bytes",
                   std::to_string(size));
}

}  // namespace opaline
