// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ and its material libraries (MTL): a shape for the faces of each material.
#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <map>
#include <optional>

#include "asset_files/asset_bytes.h"
#include "asset_files/asset_file.h"
#include "assets/asset_scene.h"
#include "assets/mtl_library.h"
#include "assets/mtl_texture.h"
#include "core/byte_order_mark.h"
#include "core/lower_case.h"
#include "core/text_lines.h"
#include "geometry/formats/obj_material.h"
#include "image/texture_file.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr Vec3d kGrey{.5, .5, .5};

/// Three finite numbers; none: the line has fewer.
std::optional<Vec3d> three_numbers(std::string_view line) {
  Vec3d value;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = number_of(next_word(line));
    if (!number) return std::nullopt;
    value[i] = *number;
  }
  return value;
}

/// "a, b and c"
std::string in_a_row(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  return text;
}

/// A name without a comment after it; the name itself if nothing else remains.
std::string_view without_comment(std::string_view name) {
  for (std::size_t at = name.find('#'); at != name.npos; at = name.find('#', at + 1))
    if (at > 0 && kLineBlanks.find(name[at - 1]) != kLineBlanks.npos) return trimmed(name.substr(0, at));
  return name;
}

/// A backslash at the end of a line continues it. Empty lines follow it, so that others keep their number.
void join_continued_lines(std::string& text) {
  std::size_t joined = 0, to = 0;
  for (std::size_t from = 0; from < text.size(); ++from) {
    const std::size_t end = text.compare(from + 1, 1, "\r") == 0 ? from + 2 : from + 1;
    if (text[from] == '\\' && end < text.size() && text[end] == '\n') {
      text[to++] = ' ';
      from = end;
      ++joined;
      continue;
    }
    text[to++] = text[from];
    for (; text[from] == '\n' && joined > 0; --joined) text[to++] = '\n';
  }
  text.resize(to);
}

/// The text of a file, with continued lines joined.
std::string read_asset_text(const std::string& path) {
  std::string text = read_asset_bytes(path);
  drop_byte_order_mark(path, text);
  end_lines_with_line_feeds(text);
  join_continued_lines(text);
  return text;
}

/// A line's names of files.
struct NamedFiles {
  std::string names;
  std::size_t line = 0;
};

/// A material with faces.
struct UsedMaterial {
  std::string name;
  std::size_t line = 0;  ///< line of its first usemtl with faces
};

/// Statements of an OBJ file besides its faces.
struct ObjOutline {
  bool has_uvs = false, has_colors = false;
  std::vector<Vec3d> vertices;
  std::vector<NamedFiles> libraries;
  std::vector<UsedMaterial> materials;  ///< in the order of the file
};

ObjOutline read_outline(const std::string& text) {
  ObjOutline outline;
  UsedMaterial material{std::string(kNoMaterial)};
  std::set<std::string> used;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v") {
      const auto position = three_numbers(line);  // reported by the reader of the mesh
      if (position && max_component(component_max(*position, -*position)) < 1e18)
        outline.vertices.push_back(*position);
      for (int i = 0; i < 3; ++i) next_word(line);
      outline.has_colors = outline.has_colors || three_numbers(line);
    } else if (keyword == "vt") {
      outline.has_uvs = true;
    } else if (keyword == "mtllib") {
      outline.libraries.push_back({std::string(trimmed(line)), number});
    } else if (keyword == "usemtl") {
      material = {obj_material_name(trimmed(line)), number};
    } else if (keyword == "f" && used.insert(material.name).second) {
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
    const std::string text = read_asset_text(path_);
    if (text.empty()) throw bad_file(path_, "the file is empty");
    const ObjOutline outline = read_outline(text);
    if (outline.materials.empty())
      throw bad_file(path_, "contains no faces", "an OBJ mesh: lines with v x y z and f 1 2 3",
                     fmt::format("{} vertices", outline.vertices.size()));
    enclose(scene_, [&](const auto& visit) { std::ranges::for_each(outline.vertices, visit); });
    scene_.is_one_mesh = true;
    has_uvs_ = outline.has_uvs;
    scene_.has_vertex_colors = outline.has_colors;
    scene_.translated.push_back("OBJ has no unit: lengths are read as millimetres");
    for (const NamedFiles& library : outline.libraries) read_libraries(library);
    for (const UsedMaterial& material : outline.materials) add_shape(material);
    warn_of_missing_materials();
    return std::move(scene_);
  }

 private:
  struct Bump {
    std::string key, keyword;  ///< key of the shape, keyword of the library
    Json texture;
  };

  struct Picture {
    Json texture;
    double gain;  ///< times its colours
  };

  /// A surface as the scene has it.
  struct Surface {
    std::optional<Vec3d> color;
    std::optional<Picture> picture;
    std::optional<Bump> bump;
    Vec3d emission{0, 0, 0};
    std::optional<Picture> emission_picture;
    Json opacity;                     ///< texture; null: opaque
    std::vector<std::string> unused;  ///< statements without an analogue, each once
  };

  /// One file with blanks in its name, or several names.
  void read_libraries(const NamedFiles& library) {
    const auto& [names, line] = library;
    if (const std::string whole = find(names, path_, line, "mtllib"); !whole.empty())
      return read_library(whole);
    std::string_view rest = without_comment(names);
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

  /// File named on a line; empty: missing.
  std::string find(const std::string& name, const std::string& named_in, std::size_t line,
                   const std::string& keyword) {
    const std::filesystem::path folder = std::filesystem::path(named_in).parent_path();
    NamedFile file = find_named_file(name, path_, folder);
    if (const std::string alone(without_comment(name)); file.path.empty() && alone != name)
      file = find_named_file(alone, path_, folder);
    if (!file.warning.empty()) warn(named_in, line, keyword + ' ' + file.warning);
    return file.path.string();
  }

  /// A later definition of a material replaces the earlier one, as in other programs.
  void read_library(const std::string& path) {
    const MtlLibrary library = read_mtl_library(path, read_asset_text(path));
    for (const MtlStatement& statement : library.unassigned)
      warn(path, statement.line,
           "the statement " + in_quotes(statement.keyword) + " precedes the first newmtl and is ignored");
    for (const MtlMaterial& material : library.materials) {
      const auto [known, is_new] = materials_.try_emplace(material.name, material);
      if (is_new) continue;
      warn(path, material.line,
           fmt::format("the material {} is defined again and replaces the one of {}:{}",
                       in_quotes(material.name), known->second.file, known->second.line));
      known->second = material;
    }
  }

  /// Warns of a statement of a material.
  void warn(const MtlMaterial& material, const MtlStatement& statement, const std::string& complaint) {
    warn(material.file, statement.line,
         statement.keyword + (statement.text.empty() ? "" : ' ' + in_quotes(statement.text)) + " of " +
             material_label(material.name) + ' ' + complaint);
  }

  /// Warns of ignored statements of a material, once, at the first.
  void warn_of_ignored(const MtlMaterial& material, const std::vector<MtlStatement>& ignored,
                       const std::string& reason) {
    if (ignored.empty()) return;
    std::vector<std::string> keywords;
    for (const MtlStatement& statement : ignored)
      if (std::ranges::find(keywords, statement.keyword) == keywords.end())
        keywords.push_back(statement.keyword);
    warn(material.file, ignored.front().line,
         in_a_row(keywords) + " of " + material_label(material.name) +
             (keywords.size() == 1 ? " is" : " are") + " ignored: " + reason);
  }

  /// Warns of the materials that are in no library, once, at the first.
  void warn_of_missing_materials() {
    constexpr std::size_t kMostNamed = 3;
    if (missing_.empty()) return;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(kMostNamed, missing_.size()); ++i)
      names.push_back(in_quotes(missing_[i].name));
    if (missing_.size() > kMostNamed) names.push_back(fmt::format("{} more", missing_.size() - kMostNamed));
    warn(path_, missing_.front().line,
         fmt::format("{} {}: not found in any library; uses grey",
                     missing_.size() == 1 ? "material" : "materials", in_a_row(names)));
  }

  Surface surface_of(const MtlMaterial& material) {
    Surface surface;
    surface.color = kGrey;
    std::vector<MtlStatement> transparency, textures;
    for (const MtlStatement& statement : material.statements) {
      const MtlUse use = use_of(statement);
      const bool needs_uvs = use == MtlUse::color_map || use == MtlUse::emission_map || use == MtlUse::bump ||
                             use == MtlUse::normal_map || use == MtlUse::opacity_map;
      if (needs_uvs && !has_uvs_)
        add_unused(surface, statement.keyword + " (the mesh has no UVs)");
      else if (use == MtlUse::color)
        take_color(material, statement, surface);
      else if (use == MtlUse::color_map)
        take_picture(material, statement, surface.picture);
      else if (use == MtlUse::emission_map)
        take_picture(material, statement, surface.emission_picture);
      else if (use == MtlUse::opacity_map)
        take_opacity(material, statement, surface);
      else if (needs_uvs)
        take_bump(material, statement, surface);
      else if (use == MtlUse::emission)
        take_emission(material, statement, surface);
      else if (use == MtlUse::transparency)
        transparency.push_back(statement);
      else if (use == MtlUse::without_analogue && in_lower_case(statement.keyword).starts_with("map_"))
        textures.push_back(statement);
      else if (use == MtlUse::without_analogue)
        add_unused(surface, statement.keyword);
      else if (use == MtlUse::unknown)
        warn(material.file, statement.line,
             "the statement " + in_quotes(statement.keyword) + " of " + material_label(material.name) +
                 " is unknown and ignored" + mtl_suggestion(statement.keyword));
    }
    warn_of_ignored(material, transparency, "transparency is not supported; the surface renders opaque");
    warn_of_ignored(material, textures, "the supported textures are map_Kd, map_Ke, map_d, bump and norm");
    return surface;
  }

  static void add_unused(Surface& surface, const std::string& what) {
    if (std::ranges::find(surface.unused, what) == surface.unused.end()) surface.unused.push_back(what);
  }

  void take_color(const MtlMaterial& material, const MtlStatement& statement, Surface& surface) {
    const auto& [value, complaint] = read_mtl_color(statement.text);
    if (value) surface.color = value;
    if (!complaint.empty()) warn(material, statement, complaint);
  }

  void take_emission(const MtlMaterial& material, const MtlStatement& statement, Surface& surface) {
    const auto& [value, complaint] = read_mtl_color(statement.text, std::numeric_limits<double>::infinity());
    if (value) surface.emission = *value;
    if (!complaint.empty()) warn(material, statement, complaint);
  }

  /// An image as a scene file's texture, with its options; null: no such file.
  /// out   file: its path
  Json texture_of(const MtlMaterial& material, const MtlStatement& statement, const MtlTexture& texture,
                  std::string& file) {
    const std::string label = label_of(material, statement, texture);
    if (texture.name.empty()) {
      warn(material.file, statement.line, label + ": it names no file");
      return {};
    }
    file = find(texture.name, material.file, statement.line, statement.keyword);
    if (file.empty()) {
      warn(material.file, statement.line, label + ": there is no such file");
      return {};
    }
    for (const std::string& option : texture.not_carried)
      warn(material.file, statement.line, label + ": the option " + in_quotes(option) + " is ignored");
    if (texture.base != 0)
      warn(material.file, statement.line,
           label + fmt::format(": the base {} of -mm is ignored; the gain {} applies", texture.base,
                               texture.gain));
    Json json{{"texture", scene_name_of(file, path_, mesh_path_)}};
    const auto& [scale_u, scale_v] = texture.scale;
    const std::array<double, 2> offset{texture.offset[0], 1 - scale_v - texture.offset[1]};
    if (texture.scale != std::array<double, 2>{1, 1}) json["uv_scale"] = {scale_u, scale_v};
    if (offset != std::array<double, 2>{0, 0}) json["uv_offset"] = offset;  // v increases downwards
    return json;
  }

  static std::string label_of(const MtlMaterial& material, const MtlStatement& statement,
                              const MtlTexture& texture) {
    return statement.keyword + ' ' + in_quotes(texture.name) + " of " + material_label(material.name);
  }

  /// The file as an image; null after a warning: it cannot be read.
  std::shared_ptr<const TextureFile> opened(const MtlMaterial& material, const MtlStatement& statement,
                                            const MtlTexture& texture, const std::string& file,
                                            bool is_color) {
    try {
      return scene_.textures.emplace_back(TextureFile::open_as(file, is_color));
    } catch (const Error& failure) {
      if (failure.kind != ErrorKind::bad_input) throw;
      warn(material.file, statement.line, label_of(material, statement, texture) + ": " + failure.message);
      return nullptr;
    }
  }

  void take_picture(const MtlMaterial& material, const MtlStatement& statement,
                    std::optional<Picture>& picture) {
    const MtlTexture texture = read_mtl_texture(statement.text);
    std::string file;
    Json json = texture_of(material, statement, texture, file);
    if (json.is_null()) return;
    if (opened(material, statement, texture, file, true) != nullptr)
      picture = {std::move(json), texture.gain};
  }

  /// The value of -bm is the height of white, in the OBJ's unit. Some programs write normal maps here,
  /// recognised by their blue mean; `norm` always is one.
  void take_bump(const MtlMaterial& material, const MtlStatement& statement, Surface& surface) {
    const MtlTexture texture = read_mtl_texture(statement.text);
    std::string file;
    Json json = texture_of(material, statement, texture, file);
    if (json.is_null()) return;
    if (const double height = texture.bump * texture.gain; height != 1) json["scale"] = height;
    const std::shared_ptr<const TextureFile> picture = opened(material, statement, texture, file, false);
    if (picture == nullptr) return;
    const Texel mean = picture->mean();
    const bool is_normal_map = use_of(statement) == MtlUse::normal_map ||
                               (mean[2] > .6 && mean[2] > mean[0] + .1 && mean[2] > mean[1] + .1);
    surface.bump = {is_normal_map ? "normal_map" : "bump_map", statement.keyword, std::move(json)};
  }

  /// By the image's alpha where it has one.
  void take_opacity(const MtlMaterial& material, const MtlStatement& statement, Surface& surface) {
    const MtlTexture texture = read_mtl_texture(statement.text);
    std::string file;
    Json json = texture_of(material, statement, texture, file);
    if (json.is_null()) return;
    const std::shared_ptr<const TextureFile> picture = opened(material, statement, texture, file, false);
    if (picture == nullptr) return;
    if (picture->has_channel(3)) json["channel"] = "a";
    if (texture.gain != 1) json["scale"] = texture.gain;
    surface.opacity = std::move(json);
  }

  void add_shape(const UsedMaterial& used) {
    const std::string& material = used.name;
    const std::string name = names_.take(material == kNoMaterial ? "" : material, "shape");
    scene_.shapes.push_back({{"name", name}, {"file", mesh_path_}, {"part", material}});
    scene_.material_names.push_back(material);
    const auto found = materials_.find(material);
    const Surface surface = found == materials_.end() ? Surface{} : surface_of(found->second);
    if (found == materials_.end() && material != kNoMaterial && !scene_.has_vertex_colors)
      missing_.push_back(used);
    if (const Json reflectance = reflectance_of(material, surface); !reflectance.is_null())
      scene_.shapes.back()["reflectance"] = reflectance;
    if (surface.bump) add_bump(material, *surface.bump);
    add_emission(material, surface);
    add_opacity(material, surface);
    if (!surface.unused.empty())
      scene_.not_carried.push_back(material_label(material) + ": " + in_a_row(surface.unused) +
                                   (surface.unused.size() == 1 ? " is" : " are") + " ignored");
  }

  void add_bump(const std::string& material, const Bump& bump) {
    scene_.shapes.back()[bump.key] = bump.texture;
    const double scale = bump.texture.value("scale", 1.0);
    scene_.translated.push_back(fmt::format("{}: {} -> {} {}, {}", material_label(material), bump.keyword,
                                            bump.key, bump.texture["texture"].get<std::string>(),
                                            bump.key == "bump_map"
                                                ? fmt::format("white {:.4g} mm high", scale)
                                                : fmt::format("slopes times {:.4g}", scale)));
  }

  void add_opacity(const std::string& material, const Surface& surface) {
    if (surface.opacity.is_null()) return;
    if (scene_.shapes.back().contains("emission")) {
      scene_.not_carried.push_back(material_label(material) + ": map_d, as an emitting surface has no holes");
      return;
    }
    scene_.shapes.back()["opacity"] = surface.opacity;
    scene_.translated.push_back(fmt::format("{}: map_d -> opacity {}", material_label(material),
                                            surface.opacity["texture"].get<std::string>()));
  }

  /// Beside an image, black counts as white, as for Kd.
  void add_emission(const std::string& material, const Surface& surface) {
    const bool is_white = surface.emission_picture && surface.emission == Vec3d(0);
    const Vec3d radiance = is_white ? Vec3d(1) : surface.emission;
    if (radiance == Vec3d(0)) return;
    Json emission = triple_json(radiance);
    if (surface.emission_picture) {
      emission = surface.emission_picture->texture;
      emission["scale"] = triple_json(radiance * surface.emission_picture->gain);
    }
    scene_.shapes.back()["emission"] = std::move(emission);
    scene_.translated.push_back(fmt::format("{}: {} -> emission {}", material_label(material),
                                            surface.emission_picture ? "map_Ke" : "Ke",
                                            short_triple(radiance)));
  }

  /// Null: the vertices have it.
  Json reflectance_of(const std::string& material, const Surface& surface) {
    const Vec3d reflectance = surface.color.value_or(kGrey);
    const std::string label = material_label(material);
    if (surface.picture) {
      Json texture = surface.picture->texture;
      const auto name = texture["texture"].get<std::string>();
      // Programs may write black as the colour beside an image; grey replaces it.
      const bool has_color = reflectance != Vec3d() && reflectance != kGrey && reflectance != Vec3d(1);
      const double gain = surface.picture->gain;
      if (has_color || gain != 1) texture["scale"] = triple_json((has_color ? reflectance : Vec3d(1)) * gain);
      scene_.translated.push_back(fmt::format("{}: map_Kd -> reflectance {}{}", label, name,
                                              has_color ? " times Kd " + short_triple(reflectance) : ""));
      return texture;
    }
    if (!surface.color && scene_.has_vertex_colors) {
      scene_.translated.push_back(label + ": vertex colours -> reflectance");
      return nullptr;
    }
    if (surface.color)
      scene_.translated.push_back(
          fmt::format("{}: Kd -> reflectance {} (opaque)", label, short_triple(reflectance)));
    return triple_json(reflectance);
  }

  const std::string& path_;
  std::string mesh_path_;
  AssetScene scene_;
  UniqueNames names_;
  bool has_uvs_ = false;
  std::map<std::string, MtlMaterial> materials_;  // by name
  std::vector<UsedMaterial> missing_;             // in no library
};

}  // namespace

AssetScene import_obj(const std::string& path, const std::string& mesh_path) {
  return ObjImporter(path, mesh_path).run();
}

}  // namespace opaline
