// SPDX-License-Identifier: GPL-3.0-or-later
// Constants, images, bumps and fuzz of MaterialX's open_pbr_surface and standard_surface. Both describe a translucent body
// by its diffuse colour and mean free paths, like the artist's medium of a scene file, so no inversion is
// necessary.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <pugixml.hpp>

#include "asset_files/asset_bytes.h"
#include "asset_files/asset_file.h"
#include "assets/asset_scene.h"
#include "assets/materialx_bump.h"
#include "core/rgb_primaries.h"
#include "core/srgb.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr double kMostSpecularAnisotropy = .98, kMostAnisotropy = .99, kLeastIor = .1, kMostIor = 10;

/// Input names of a surface model, and their default values.
struct SurfaceModel {
  const char *node, *base_weight, *base_color, *weight, *color, *radius, *scale, *anisotropy, *ior,
      *metalness, *specular_weight, *specular_anisotropy, *normal, *fuzz, *fuzz_color, *fuzz_roughness;
  Vec3d default_color, default_scale;
  double default_roughness, default_fuzz_roughness;
  bool has_rotation;  ///< input for the rotation of the anisotropy, in turns
};

// OpenPBR 1.1; Autodesk Standard Surface 1.0.1.
// clang-format off
constexpr std::array<SurfaceModel, 2> models{
    {{"open_pbr_surface", "base_weight", "base_color", "subsurface_weight", "subsurface_color",
      "subsurface_radius", "subsurface_radius_scale", "subsurface_scatter_anisotropy", "specular_ior",
      "base_metalness", "specular_weight", "specular_roughness_anisotropy", "geometry_normal",
      "fuzz_weight", "fuzz_color", "fuzz_roughness", Vec3d(.8), Vec3d(1, .5, .25), .3, .5, false},
     {"standard_surface", "base", "base_color", "subsurface", "subsurface_color", "subsurface_radius",
      "subsurface_scale", "subsurface_anisotropy", "specular_IOR", "metalness", "specular",
      "specular_anisotropy", "normal",
      "sheen", "sheen_color", "sheen_roughness", Vec3d(1), Vec3d(1), .2, .3, true}}};
// clang-format on
const SurfaceModel* find_model(const pugi::xml_node& node) {
  const auto found = std::ranges::find_if(
      models, [&](const SurfaceModel& model) { return node.name() == std::string_view(model.node); });
  return found == models.end() ? nullptr : &*found;
}

class SurfaceReader {
 public:
  SurfaceReader(const std::string& file, const pugi::xml_node& node, const SurfaceModel& model,
                const AssetPlace& asset, AssetScene& scene)
      : file_(file),
        node_(node),
        model_(model),
        asset_(asset),
        scene_(scene),
        label_("material " + in_quotes(node.attribute("name").value())) {}

  SurfaceTranslation run() {
    SurfaceTranslation surface;
    const double base_weight = number(model_.base_weight, 1, 0, 1), weight = number(model_.weight, 0, 0, 1);
    std::optional<Json> base_map = connected_texture(model_.base_color, true);
    if (base_map && base_weight != 1) (*base_map)["scale"] = base_weight;
    const Vec3d base = base_map ? Vec3d(base_weight) : color(model_.base_color, Vec3d(.8)) * base_weight;
    if (weight > 0) {
      surface.medium = make_medium();
      if (weight < 1) {
        surface.medium["subsurface_weight"] = weight;
        surface.medium["base_color"] = base_map.value_or(triple_json(base));
        scene_.translated.push_back(
            fmt::format("{}: {} {:.3g} -> subsurface_weight; base colour -> base_color {} of the rest",
                        label_, model_.weight, weight, short_triple(base)));
      }
    } else {
      surface.reflectance = base;
      if (base_map) surface.keys["reflectance"] = *base_map;
      scene_.translated.push_back(fmt::format("{}: {} 0, base colour -> reflectance {} (opaque)", label_,
                                              model_.weight, short_triple(base)));
      add_gloss(surface);
    }
    add_fuzz(weight > 0 ? surface.medium : surface.keys);
    add_bump(surface.keys);
    tell_losses();
    return surface;
  }

 private:
  void add_bump(Json& keys) {
    const pugi::xml_node normal = input(model_.normal);
    if (!normal) return;
    const HeightMap heights = height_map(normal);
    std::optional<Json> map = texture(heights.image, model_.normal);
    if (!map) return;
    (*map)["scale"] = heights.scale;
    keys["bump_map"] = *std::move(map);
    scene_.translated.push_back(fmt::format("{}: bump of {} -> bump_map, white {:.4g} mm high", label_,
                                            heights.image.file, heights.scale * scene_.mm_per_unit));
  }

  /// Texture of a scene file; none: reported as not carried over.
  std::optional<Json> texture(const ImageNode& image, const char* name) {
    if (image.file.empty()) {
      scene_.not_carried.push_back(fmt::format("{}: {}: {}", label_, name, image.problem));
      return {};
    }
    const NamedFile named = find_named_file(image.file, file_, std::filesystem::path(file_).parent_path());
    if (!named.warning.empty()) scene_.warn(file_, label_ + ": " + named.warning);
    // A missing file is reported on reading the scene.
    const std::filesystem::path file =
        named.path.empty() ? std::filesystem::path(file_).parent_path() / image.file : named.path;
    Json map = {{"texture", scene_name_of(file, asset_.path, asset_.mesh_path)}};
    if (image.tiling != std::array<double, 2>{1, 1}) {
      map["uv_scale"] = image.tiling;
      map["uv_offset"] = {0, 1 - image.tiling[1]};  // tile rows start at the lower edge
    }
    return map;
  }

  /// Texture connected to an input; none: it has a value, or is reported as not carried over.
  std::optional<Json> connected_texture(const char* name, bool is_color) {
    const pugi::xml_node found = input(name);
    if (!found || found.attribute("value")) return {};
    const ImageNode image = connected_image(found);
    std::optional<Json> map = texture(image, name);
    if (!map) return {};
    if (image.color_space == "srgb_texture" && is_color)
      (*map)["color_space"] = "srgb";
    else if (image.color_space == "lin_rec709" && is_color)
      (*map)["color_space"] = "linear";
    else if (is_color && !image.color_space.empty())
      scene_.not_carried.push_back(label_ + ": the colour space " + in_quotes(image.color_space) + " of " +
                                   name);
    scene_.translated.push_back(fmt::format("{}: {} -> {}", label_, name, image.file));
    return map;
  }

  /// Adds anisotropy in OpenPBR's parametrization, the scene's own. Standard Surface divides and multiplies
  /// alpha by the root of the alphas' ratio. Returns the roughness for it, 1 beside roughness_map_.
  double add_grain(Json& keys) {
    roughness_map_ = connected_texture("specular_roughness", false);
    const double roughness =
        roughness_map_ ? 1 : number("specular_roughness", model_.default_roughness, 0, 1);
    const std::optional<Json> map = connected_texture(model_.specular_anisotropy, false),
                              angles = model_.has_rotation ? connected_texture("specular_rotation", false)
                                                           : std::nullopt;
    const double anisotropy = map ? 1 : number(model_.specular_anisotropy, 0, 0, 1),
                 rotation = model_.has_rotation && !angles ? number("specular_rotation", 0, 0, 1) * 360 : 0;
    if (!(anisotropy > 0)) return roughness;
    const double ratio = 1 - std::min(anisotropy, kMostSpecularAnisotropy);
    const double scale = model_.has_rotation && !map ? std::pow((ratio + 1 / ratio) / 2, .25) : 1;
    const double mean = std::min(roughness * scale, 1.);
    if (roughness_map_ && scale != 1) (*roughness_map_)["scale"] = scale;
    keys["specular_anisotropy"] = map.value_or(1 - ratio);
    keys["specular_rotation"] = angles.value_or(rotation);
    scene_.translated.push_back(fmt::format(
        "{}: {} {:.3g} -> specular_anisotropy {:.3g}, specular_rotation {:.4g}, specular_roughness {:.3g}",
        label_, model_.specular_anisotropy, anisotropy, 1 - ratio, rotation, mean));
    return mean;
  }

  void add_fuzz(Json& keys) {
    const std::optional<Json> weights = connected_texture(model_.fuzz, false),
                              colors = connected_texture(model_.fuzz_color, true),
                              roughnesses = connected_texture(model_.fuzz_roughness, false);
    const double weight = weights ? 1 : number(model_.fuzz, 0, 0, 1),
                 roughness =
                     roughnesses ? 1 : number(model_.fuzz_roughness, model_.default_fuzz_roughness, 0, 1);
    const Vec3d fibres = colors ? Vec3d(1) : color(model_.fuzz_color, Vec3d(1));
    if (!(weight > 0)) return;
    keys["fuzz_weight"] = weights.value_or(weight);
    keys["fuzz_color"] = colors.value_or(triple_json(fibres));
    keys["fuzz_roughness"] = roughnesses.value_or(roughness);
    scene_.translated.push_back(
        fmt::format("{}: {} {:.3g}, {} {} -> fuzz_weight, fuzz_color, fuzz_roughness {:.3g}", label_,
                    model_.fuzz, weight, model_.fuzz_color, short_triple(fibres), roughness));
  }

  void add_gloss(SurfaceTranslation& surface) {
    const double metalness = number(model_.metalness, 0, 0, 1),
                 weight = number(model_.specular_weight, 1, 0, 1),
                 ior = number(model_.ior, 1.5, kLeastIor, kMostIor), roughness = add_grain(surface.keys);
    surface.keys["metalness"] = metalness;
    surface.keys["specular_roughness"] = roughness_map_.value_or(roughness);
    surface.keys["specular_ior"] = ior;
    surface.keys["specular_weight"] = weight;
    scene_.translated.push_back(
        fmt::format("{}: {} {:.3g}, {} {:.3g} -> metalness, specular_weight, specular_roughness {:.3g}, "
                    "specular_ior {:.4g}",
                    label_, model_.metalness, metalness, model_.specular_weight, weight, roughness, ior));
  }

  Json make_medium() {
    const std::optional<Json> color_map = connected_texture(model_.color, true);
    const Vec3d reflected = color_map ? Vec3d(1) : color(model_.color, model_.default_color);
    const Vec3d radius = lengths(model_.radius, Vec3d(1)) * lengths(model_.scale, model_.default_scale);
    const Vec3d radius_mm = radius * scene_.mm_per_unit;
    const double g = number(model_.anisotropy, 0, -kMostAnisotropy, kMostAnisotropy);
    const double ior = number(model_.ior, 1.5, kLeastIor, kMostIor);
    Json medium = Json::object();
    const double roughness = add_grain(medium);
    const double weight = number(model_.specular_weight, 1, 0, 1);
    scene_.translated.push_back(fmt::format(
        "{}: {} {}, {} times {} {} scene units -> subsurface_color, subsurface_radius {} mm, "
        "anisotropy {:.3g}, specular_ior {:.4g}, specular_roughness {:.3g}, specular_weight {:.3g}",
        label_, model_.color, short_triple(reflected), model_.radius, model_.scale, short_triple(radius),
        short_triple(radius_mm), g, ior, roughness, weight));
    medium.update({{"subsurface_color", color_map.value_or(triple_json(reflected))},
                   {"subsurface_radius", triple_json(radius_mm)},
                   {"subsurface_scatter_anisotropy", g},
                   {"specular_ior", ior},
                   {"specular_roughness", roughness_map_.value_or(roughness)},
                   {"specular_weight", weight}});
    return medium;
  }

  pugi::xml_node input(const char* name) {
    read_.insert(name);
    return node_.find_child_by_attribute("input", "name", name);
  }

  /// Numbers of an input; none without a value of its own.
  std::vector<double> numbers(const char* name) {
    const pugi::xml_node found = input(name);
    if (!found) return {};
    if (!found.attribute("value")) {
      scene_.not_carried.push_back(label_ + ": connection of " + name + ": ignored, uses the default");
      return {};
    }
    std::vector<double> values;
    const std::string_view text = found.attribute("value").value();
    for (std::size_t at = 0; at <= text.size();) {
      const std::size_t comma = std::min(text.find(',', at), text.size());
      std::string_view word = text.substr(at, comma - at);
      while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
      while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) fail(name, text);
      values.push_back(value);
      at = comma + 1;
    }
    if (values.size() != 1 && values.size() != 3) fail(name, text);
    return values;
  }

  [[noreturn]] void fail(const char* name, std::string_view got) const {
    throw bad_file(file_, label_ + ": bad input " + in_quotes(name),
                   "one number, or three separated by commas", in_quotes(got));
  }

  double number(const char* name, double otherwise, double low, double high) {
    const std::vector<double> values = numbers(name);
    if (values.empty()) return otherwise;
    if (values.size() != 1 || values[0] < low || values[0] > high)
      throw bad_file(file_, label_ + ": bad input " + in_quotes(name),
                     fmt::format("a number from {} to {}", low, high), fmt::format("{}", values[0]));
    return values[0];
  }

  Vec3d triple(const char* name, const Vec3d& otherwise) {
    const std::vector<double> values = numbers(name);
    if (values.empty()) return otherwise;
    return values.size() == 1 ? Vec3d(values[0]) : Vec3d(values[0], values[1], values[2]);
  }

  Vec3d lengths(const char* name, const Vec3d& otherwise) {
    return component_max(triple(name, otherwise), Vec3d(0));
  }

  Vec3d color(const char* name, const Vec3d& otherwise) {
    return component_min(component_max(to_rec709(name, triple(name, otherwise)), Vec3d(0)), Vec3d(1));
  }

  /// Converts from the innermost given colour space: the input's, the surface's, the file's.
  Vec3d to_rec709(const char* name, const Vec3d& color) {
    const pugi::xml_node own = input(name);
    std::string space;
    for (pugi::xml_node at = own ? own : node_; at && space.empty(); at = at.parent())
      space = at.attribute("colorspace").value();
    if (!own || space.empty() || space == "lin_rec709" || space == "none") return color;
    if (space == "srgb_texture")
      return {srgb_to_linear(color.x), srgb_to_linear(color.y), srgb_to_linear(color.z)};
    if (space == "acescg" || space == "lin_ap1") return color_matrix(kAp1Primaries, kRec709Primaries) * color;
    scene_.not_carried.push_back(label_ + ": the colour space " + in_quotes(space) + " of " + name);
    return color;
  }

  void tell_losses() {
    for (const pugi::xml_node& other : node_.children("input")) {
      const std::string name = other.attribute("name").value();
      if (!read_.contains(name)) scene_.not_carried.push_back(label_ + ": " + name);
    }
  }

  const std::string& file_;
  pugi::xml_node node_;
  const SurfaceModel& model_;
  const AssetPlace& asset_;
  AssetScene& scene_;
  std::string label_;
  std::set<std::string> read_;
  std::optional<Json> roughness_map_;
};

/// The surface itself, or that of the material with this name; without a name the first of the file.
pugi::xml_node find_surface(const pugi::xml_node& root, const std::string& name) {
  pugi::xml_node material = root.find_child_by_attribute("surfacematerial", "name", name.c_str());
  const pugi::xml_node shader = material.find_child_by_attribute("input", "name", "surfaceshader");
  const std::string wanted = shader ? shader.attribute("nodename").value() : name;
  return root.find_child([&](const pugi::xml_node& node) {
    return find_model(node) != nullptr && (wanted.empty() || node.attribute("name").value() == wanted);
  });
}

/// "MaterialX 1.37" for a file with the syntax before 1.38, with shaders inside materials; otherwise empty.
std::string old_version(const pugi::xml_node& root) {
  const std::string version = root.attribute("version").value();
  const bool is_old = version.starts_with("1.") && std::atoi(version.c_str() + 2) < 38;
  const bool has_references = root.child("material").child("shaderref");
  if (!is_old && !has_references) return {};
  return "MaterialX " + (is_old ? version : "1.37");
}

/// Names of all surfaces but one.
std::string surface_names(const pugi::xml_node& root, const pugi::xml_node& but = {}) {
  std::string names;
  for (const pugi::xml_node& node : root.children())
    if (find_model(node) != nullptr && node != but)
      names += (names.empty() ? "" : ", ") + in_quotes(node.attribute("name").value());
  return names;
}

/// Root of a MaterialX file.
pugi::xml_node load(const std::string& file, pugi::xml_document& document) {
  const std::string bytes = read_asset_bytes(file);
  const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size());
  if (!result) {
    const auto line =
        1 + std::count(bytes.begin(),
                       bytes.begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(bytes)), '\n');
    throw Error(ErrorKind::bad_input, file, int(line), 0, std::string("is not XML: ") + result.description());
  }
  const pugi::xml_node root = document.child("materialx");
  if (!root) throw bad_file(file, "is not a MaterialX file", "the element materialx");
  return root;
}

}  // namespace

std::set<std::string> materialx_names(const std::string& file) {
  pugi::xml_document document;
  const pugi::xml_node root = load(file, document);
  std::set<std::string> names;
  for (const pugi::xml_node& material : root.children("surfacematerial"))
    if (const std::string name = material.attribute("name").value(); find_surface(root, name))
      names.insert(name);
  return names;
}

SurfaceTranslation translate_materialx(const std::string& file_and_name, const AssetPlace& asset,
                                       AssetScene& scene) {
  const std::size_t hash = file_and_name.rfind('#');
  const std::string file = file_and_name.substr(0, hash);
  const std::string name = hash == file_and_name.npos ? "" : file_and_name.substr(hash + 1);
  pugi::xml_document document;
  const pugi::xml_node root = load(file, document);
  const pugi::xml_node surface = find_surface(root, name);
  if (const std::string version = old_version(root); !surface && !version.empty())
    throw bad_file(file, version + " syntax; save it as 1.38");
  if (const std::string others = surface_names(root, surface); !surface)
    throw bad_file(
        file, "has no such surface",
        others.empty() ? "a file with an open_pbr_surface or standard_surface" : "one of " + others,
        name.empty() ? "" : in_quotes(name));
  else if (name.empty() && !others.empty())
    scene.warn(file, fmt::format("{} is the material of all shapes; others of the file, by FILE#NAME: {}",
                                 in_quotes(surface.attribute("name").value()), others));
  return SurfaceReader(file, surface, *find_model(surface), asset, scene).run();
}

}  // namespace opaline
