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
  std::string_view extension, name, instead = "GLB";
};

constexpr std::string_view kOfUsd = "GLB, or convert it with opaline-usd";

constexpr std::array<Format, 26> kFormats{{{".fbx", "FBX"},
                                           {".blend", "Blender's .blend"},
                                           {".abc", "Alembic"},
                                           {".usd", "USD", kOfUsd},
                                           {".usda", "USD", kOfUsd},
                                           {".usdc", "USD", kOfUsd},
                                           {".usdz", "USD", kOfUsd},
                                           {".dae", "Collada"},
                                           {".3ds", "3DS"},
                                           {".max", "3ds Max's .max"},
                                           {".ma", "Maya's .ma"},
                                           {".mb", "Maya's .mb"},
                                           {".c4d", "Cinema 4D's .c4d"},
                                           {".lwo", "LightWave's .lwo"},
                                           {".ztl", "ZBrush's .ztl"},
                                           {".skp", "SketchUp's .skp"},
                                           {".x3d", "X3D"},
                                           {".x3dv", "X3D"},
                                           {".wrl", "VRML"},
                                           {".3mf", "3MF", "STL"},
                                           {".3dm", "Rhino's .3dm", "STL"},
                                           {".step", "STEP", "STL"},
                                           {".stp", "STEP", "STL"},
                                           {".iges", "IGES", "STL"},
                                           {".igs", "IGES", "STL"},
                                           {".fcstd", "FreeCAD's .FCStd", "STL"}}};

}  // namespace

std::string unread_format(const std::string& path) {
  const std::string extension = in_lower_case(std::filesystem::path(path).extension().string());
  const auto found = std::ranges::find(kFormats, std::string_view(extension), &Format::extension);
  if (found == kFormats.end()) return {};
  return std::string(found->name) + " is not supported; export " + std::string(found->instead);
}

}  // namespace opaline
