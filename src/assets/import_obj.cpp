// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ and its material libraries (MTL): a shape for the faces of each material.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <map>
#include <optional>

#include "assets/asset_bytes.h"
#include "assets/asset_file.h"
#include "assets/asset_scene.h"
#include "assets/mtl_texture.h"
#include "opaline/assets/obj_material.h"
#include "opaline/core/byte_order_mark.h"
#include "opaline/core/error.h"
#include "opaline/image/texture_file.h"

namespace opaline {
namespace {

constexpr Vec3d kGrey{.5, .5, .5};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\v\f");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\v\f") + 1 - first);
}

/// Takes the first word off a line.
std::string_view next_word(std::string_view& line) {
  line = trimmed(line);
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r\v\f"));
  line.remove_prefix(word.size());
  return word;
}

/// visit: of a line and its number, from 1
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    visit(text.substr(0, end), number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Three finite numbers; none: the line has fewer.
std::optional<Vec3d> three_numbers(std::string_view line) {
  Vec3d value;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string_view word = next_word(line);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value[i]);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value[i]))
      return std::nullopt;
  }
  return value;
}

/// The text of a file.
std::string read_asset_text(const std::string& path) {
  std::string text = read_asset_bytes(path);
  drop_byte_order_mark(path, text);
  end_lines_with_line_feeds(text);
  return text;
}

/// A line's names of files.
struct NamedFiles {
  std::string names;
  std::size_t line = 0;
};

/// What an OBJ file says beside its faces.
struct ObjOutline {
  bool has_uvs = false, has_colors = false;
  std::vector<Vec3d> vertices;
  std::vector<NamedFiles> libraries;
  std::vector<std::string> materials;  ///< that have faces, in the order of the file
};

ObjOutline read_outline(const std::string& text) {
  ObjOutline outline;
  std::string material(kNoMaterial);
  std::set<std::string> used;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v") {
      const auto position = three_numbers(line);  // where they are none, the reader of the mesh says so
      if (position && max_component(component_max(*position, -*position)) < 1e18)
        outline.vertices.push_back(*position);
      for (int i = 0; i < 3; ++i) next_word(line);
      outline.has_colors = outline.has_colors || three_numbers(line);
    } else if (keyword == "vt") {
      outline.has_uvs = true;
    } else if (keyword == "mtllib") {
      outline.libraries.push_back({std::string(trimmed(line)), number});
    } else if (keyword == "usemtl") {
      material = obj_material_name(trimmed(line));
    } else if (keyword == "f" && used.insert(material).second) {
      outline.materials.push_back(material);
    }
  });
  return outline;
}

class ObjImporter {
 public:
  ObjImporter(const std::string& path, std::string mesh_path)
      : path_(path), mesh_path_(std::move(mesh_path)) {}

  AssetScene run() {
    const ObjOutline outline = read_outline(read_asset_text(path_));
    if (outline.materials.empty()) throw bad_file(path_, "shows nothing", "a mesh with faces");
    enclose(scene_, [&](const auto& visit) { std::ranges::for_each(outline.vertices, visit); });
    scene_.is_one_mesh = true;
    has_uvs_ = outline.has_uvs;
    scene_.has_vertex_colors = outline.has_colors;
    scene_.translated.push_back("OBJ has no unit: lengths are taken for millimetres");
    for (const NamedFiles& library : outline.libraries) read_libraries(library);
    for (const std::string& material : outline.materials) add_shape(material);
    return std::move(scene_);
  }

 private:
  struct Bump {
    std::string key, keyword;  ///< of the shape, of the library
    Json texture;
  };

  struct Picture {
    Json texture;
    double gain;  ///< times its colours
  };

  /// A line of a library, the file `mtl`.
  struct Statement {
    const std::string& mtl;
    std::size_t line;
    const std::string &material, &keyword;
    std::string_view text;  ///< behind the keyword
  };

  /// One file, whose name may have blanks in it, or several names.
  void read_libraries(const NamedFiles& library) {
    const auto& [names, line] = library;
    if (const std::string whole = find(names, path_, line, "mtllib"); !whole.empty())
      return read_library(whole);
    std::string_view rest = names;
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest)) {
      const std::string file = find(std::string(name), path_, line, "mtllib");
      if (file.empty())
        warn(path_, line, "mtllib " + in_quotes(name) + ": there is no such file");
      else
        read_library(file);
    }
  }

  void warn(const std::string& file, std::size_t line, const std::string& what) {
    scene_.warn(fmt::format("{}:{}", file, line), what);
  }

  /// The file that a line names; empty: there is none.
  std::string find(const std::string& name, const std::string& named_in, std::size_t line,
                   const std::string& keyword) {
    const NamedFile file = find_named_file(name, path_, std::filesystem::path(named_in).parent_path());
    if (!file.warning.empty()) warn(named_in, line, keyword + ' ' + file.warning);
    return file.path.string();
  }

  void read_library(const std::string& path) {
    std::string material;
    for_each_line(read_asset_text(path), [&](std::string_view line, std::size_t number) {
      const std::string keyword(next_word(line));
      if (keyword == "newmtl") {
        material = obj_material_name(trimmed(line));
        colors_.try_emplace(material, kGrey);
      } else if (keyword == "Kd" && !material.empty()) {
        if (const auto color = three_numbers(line))
          colors_[material] = component_min(component_max(*color, Vec3d(0)), Vec3d(1));
        else
          lost_[material].insert("Kd " + in_quotes(trimmed(line)));
      } else if (keyword == "map_Kd" && !material.empty() && has_uvs_) {
        take_picture({path, number, material, keyword, line});
      } else if (is_bump(keyword) && !material.empty() && has_uvs_) {
        take_bump({path, number, material, keyword, line});
      } else if (is_lost(keyword, line)) {
        const bool is_laid = !has_uvs_ && (keyword == "map_Kd" || is_bump(keyword));
        lost_[material].insert(keyword + (is_laid ? " (the mesh has no UVs)" : ""));
      }
    });
  }

  /// A picture as a scene file has it, laid as its options say; null: there is no such file.
  /// out   file: its path
  Json texture_of(const Statement& statement, const MtlTexture& texture, std::string& file) {
    file = find(texture.name, statement.mtl, statement.line, statement.keyword);
    const std::string label =
        statement.keyword + ' ' + in_quotes(texture.name) + " of material " + in_quotes(statement.material);
    if (file.empty()) {
      warn(statement.mtl, statement.line, label + ": there is no such file");
      return {};
    }
    for (const std::string& option : texture.not_carried)
      warn(statement.mtl, statement.line, label + ": the option " + in_quotes(option) + " is left out");
    Json json{{"texture", scene_name_of(file, path_, mesh_path_)}};
    const auto& [scale_u, scale_v] = texture.scale;
    const std::array<double, 2> offset{texture.offset[0], 1 - scale_v - texture.offset[1]};
    if (texture.scale != std::array<double, 2>{1, 1}) json["uv_scale"] = {scale_u, scale_v};
    if (offset != std::array<double, 2>{0, 0}) json["uv_offset"] = offset;  // the scene counts v downwards
    return json;
  }

  void take_picture(const Statement& statement) {
    const MtlTexture texture = read_mtl_texture(statement.text);
    std::string file;
    Json json = texture_of(statement, texture, file);
    if (json.is_null()) return;
    pictures_[statement.material] = {std::move(json), texture.gain};
  }

  static bool is_bump(const std::string& keyword) {
    return keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump" || keyword == "norm";
  }

  /// The height of white is what -bm says, in the OBJ's own lengths. Some programs write normal maps here, whose mean is
  /// blue; `norm` always is one.
  void take_bump(const Statement& statement) {
    const MtlTexture texture = read_mtl_texture(statement.text);
    std::string file;
    Json json = texture_of(statement, texture, file);
    if (json.is_null()) return;
    if (const double height = texture.bump * texture.gain; height != 1) json["scale"] = height;
    try {
      const Texel mean = TextureFile::open(file, ColorSpace::linear)->mean();
      const bool is_normal_map =
          statement.keyword == "norm" || (mean[2] > .6 && mean[2] > mean[0] + .1 && mean[2] > mean[1] + .1);
      bumps_[statement.material] = {is_normal_map ? "normal_map" : "bump_map", statement.keyword,
                                    std::move(json)};
    } catch (const Error& failure) {
      lost_[statement.material].insert(statement.keyword + ": " + failure.message);
    }
  }

  /// Whether a value changes what a matte surface looks like: black highlights and full opacity do not.
  static bool is_lost(const std::string& keyword, std::string_view line) {
    if (keyword.starts_with("map_") || keyword == "bump" || keyword == "norm" || keyword == "disp" ||
        keyword == "refl")
      return true;
    const std::string_view value = trimmed(line);
    if (keyword == "Tf") return three_numbers(line).value_or(Vec3d()) != Vec3d(1);
    if (keyword == "Pr") return !value.starts_with('1');  // rough
    if (keyword == "Pm" || keyword == "Ps" || keyword == "Pc")
      return value.find_first_not_of("0.") != value.npos;  // metalness, sheen, coat
    if (keyword == "Ks" || keyword == "Ke") return three_numbers(line).value_or(Vec3d(1)) != Vec3d();
    if (keyword == "d") return value.find_first_not_of("1.0") != value.npos || !value.starts_with('1');
    return keyword == "Tr" && value.find_first_not_of("0.") != value.npos;
  }

  void add_shape(const std::string& material) {
    const std::string name = names_.take(material == kNoMaterial ? "" : material, "shape");
    scene_.shapes.push_back({{"name", name}, {"file", mesh_path_}, {"part", material}});
    if (const Json reflectance = reflectance_of(material); !reflectance.is_null())
      scene_.shapes.back()["reflectance"] = reflectance;
    if (const auto bump = bumps_.find(material); bump != bumps_.end()) add_bump(material, bump->second);
    for (const std::string& keyword : lost_[material])
      scene_.not_carried.push_back("material " + in_quotes(material) + ": " + keyword);
  }

  void add_bump(const std::string& material, const Bump& bump) {
    scene_.shapes.back()[bump.key] = bump.texture;
    const double scale = bump.texture.value("scale", 1.0);
    scene_.translated.push_back(fmt::format("material {}: {} -> {} {}, {}", in_quotes(material), bump.keyword,
                                            bump.key, bump.texture["texture"].get<std::string>(),
                                            bump.key == "bump_map"
                                                ? fmt::format("white {:.4g} mm high", scale)
                                                : fmt::format("slopes times {:.4g}", scale)));
  }

  /// Null: the vertices have it.
  Json reflectance_of(const std::string& material) {
    const auto color = colors_.find(material);
    const Vec3d reflectance = color == colors_.end() ? kGrey : color->second;
    const std::string label = "material " + in_quotes(material);
    if (const auto picture = pictures_.find(material); picture != pictures_.end()) {
      Json texture = picture->second.texture;
      const auto name = texture["texture"].get<std::string>();
      // Programs that write a picture may leave the colour black; grey stands for none.
      const bool has_color = reflectance != Vec3d() && reflectance != kGrey && reflectance != Vec3d(1);
      const double gain = picture->second.gain;
      if (has_color || gain != 1) texture["scale"] = triple_json((has_color ? reflectance : Vec3d(1)) * gain);
      scene_.translated.push_back(fmt::format("{}: map_Kd -> reflectance {}{}", label, name,
                                              has_color ? " times Kd " + short_triple(reflectance) : ""));
      return texture;
    }
    if (color == colors_.end() && scene_.has_vertex_colors) {
      scene_.translated.push_back(label + ": vertex colours -> reflectance");
      return nullptr;
    }
    if (color != colors_.end())
      scene_.translated.push_back(
          fmt::format("{}: Kd -> reflectance {} (opaque)", label, short_triple(reflectance)));
    else if (material != kNoMaterial)
      scene_.not_carried.push_back(label + ": no library has it; taken as grey");
    return triple_json(reflectance);
  }

  const std::string& path_;
  std::string mesh_path_;
  AssetScene scene_;
  UniqueNames names_;
  bool has_uvs_ = false;
  std::map<std::string, Vec3d> colors_;                // Kd, by material
  std::map<std::string, Picture> pictures_;            // map_Kd, by material
  std::map<std::string, Bump> bumps_;                  // by material
  std::map<std::string, std::set<std::string>> lost_;  // keywords without a counterpart, by material
};

}  // namespace

AssetScene import_obj(const std::string& path, const std::string& mesh_path) {
  return ObjImporter(path, mesh_path).run();
}

}  // namespace opaline
