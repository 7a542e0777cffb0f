// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/mesh_format.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace opaline {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace

std::string extension_of(std::string_view format) {
  return '.' + lower(format);
}

const MeshFormat* find_mesh_format(const std::string& path) {
  const std::string extension = lower(std::filesystem::path(path).extension().string());
  const auto found = std::ranges::find(kMeshFormats, extension, extension_of);
  if (found == kMeshFormats.end()) return nullptr;
  return kFormats[std::size_t(found - kMeshFormats.begin())];
}

}  // namespace opaline
