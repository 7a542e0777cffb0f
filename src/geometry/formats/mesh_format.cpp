// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/mesh_format.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace opaline {

const MeshFormat* find_mesh_format(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  const auto found =
      std::ranges::find_if(mesh_formats, [&](const MeshFormat* f) { return f->extension == extension; });
  return found == mesh_formats.end() ? nullptr : *found;
}

}  // namespace opaline
