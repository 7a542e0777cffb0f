// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/unread_format.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "core/lower_case.h"

namespace opaline {
namespace {

struct Format {
  std::string_view extension, name;
};

constexpr std::array<Format, 15> kFormats{{{".fbx", "FBX"},
                                           {".blend", "Blender's .blend"},
                                           {".abc", "Alembic"},
                                           {".usd", "USD"},
                                           {".usda", "USD"},
                                           {".usdc", "USD"},
                                           {".usdz", "USD"},
                                           {".dae", "Collada"},
                                           {".3ds", "3DS"},
                                           {".max", "3ds Max's .max"},
                                           {".ma", "Maya's .ma"},
                                           {".mb", "Maya's .mb"},
                                           {".c4d", "Cinema 4D's .c4d"},
                                           {".lwo", "LightWave's .lwo"},
                                           {".ztl", "ZBrush's .ztl"}}};

}  // namespace

std::string unread_format(const std::string& path) {
  const std::string extension = in_lower_case(std::filesystem::path(path).extension().string());
  const auto found = std::ranges::find(kFormats, std::string_view(extension), &Format::extension);
  return found == kFormats.end() ? "" : std::string(found->name) + " is not supported; export GLB";
}

}  // namespace opaline
