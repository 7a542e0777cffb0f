// SPDX-License-Identifier: GPL-3.0-or-later
// MTL files as lists of statements, and their meaning.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// A line of a material library.
struct MtlStatement {
  std::size_t line = 0;
  std::string keyword;  ///< as in the file
  std::string text;     ///< after the keyword, without blanks around it
};

struct MtlMaterial {
  std::string name, file;
  std::size_t line = 0;  ///< line of its newmtl
  std::vector<MtlStatement> statements;
};

struct MtlLibrary {
  std::vector<MtlMaterial> materials;    ///< in the order of the file, each newmtl by itself
  std::vector<MtlStatement> unassigned;  ///< before the first newmtl
};

/// in    text: with line feeds
MtlLibrary read_mtl_library(const std::string& file, std::string_view text);

/// Use of a statement for a diffuse surface.
enum class MtlUse {
  color,             ///< Kd
  color_map,         ///< map_Kd
  bump,              ///< bump, map_bump
  normal_map,        ///< norm
  emission,          ///< Ke
  emission_map,      ///< map_Ke
  opacity_map,       ///< map_d
  transparency,      ///< d, Tr, Tf and the other maps
  no_effect,         ///< default values, and options of other statements
  without_analogue,  ///< would change the surface
  unknown
};

/// Case-insensitive, as programs differ in it.
MtlUse use_of(const MtlStatement& statement);

/// " (did you mean 'map_Kd'?)", or nothing.
std::string mtl_suggestion(const std::string& keyword);

/// A colour between 0 and `most`. One number applies to all three.
/// from  Wavefront, MTL material format 4.2: "the g and b are optional; if only r is specified, g and b equal
///       r"
struct MtlColor {
  std::optional<Vec3d> value;  ///< none: the text is not a colour
  std::string complaint;       ///< about the text, a verb phrase; empty: none
};
MtlColor read_mtl_color(std::string_view text, double most = 1);

}  // namespace opaline
