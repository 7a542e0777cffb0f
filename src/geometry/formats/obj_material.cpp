// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/obj_material.h"

#include <nlohmann/json.hpp>

#include "asset_files/asset_file.h"

namespace opaline {
namespace {

bool is_utf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace

std::string material_label(std::string_view name) {
  return name == kNoMaterial ? "faces without a material" : "material " + in_quotes(name);
}

std::string obj_material_name(std::string_view text) {
  if (text.empty()) return std::string(kNoMaterial);
  std::string name(text);
  if (is_utf8(name)) return name;
  name.clear();
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      name += c;
    } else {
      name += char(0xc0 | byte >> 6);
      name += char(0x80 | (byte & 0x3f));
    }
  }
  return name;
}

}  // namespace opaline
