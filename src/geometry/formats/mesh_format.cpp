// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/mesh_format.h"

#include <algorithm>
#include <filesystem>

#include "core/lower_case.h"

namespace opaline {
std::string extension_of(std::string_view format) {
  return '.' + in_lower_case(format);
}

const MeshFormat* find_mesh_format(const std::string& path) {
  const std::string extension = in_lower_case(std::filesystem::path(path).extension().string());
  const auto found = std::ranges::find(kMeshFormats, extension, extension_of);
  if (found == kMeshFormats.end()) return nullptr;
  return kFormats[std::size_t(found - kMeshFormats.begin())];
}

}  // namespace opaline
