// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes, scattering and colours of glTF materials. The scattering extensions are drafts with two spellings,
// KHR_materials_volume_scatter and KHR_materials_scatter.
#include "assets/gltf_material.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "asset_files/asset_file.h"
#include "asset_files/gltf_uv_set.h"
#include "assets/gltf_ranges.h"
#include "assets/gltf_texture.h"
#include "image/texture_file.h"

namespace opaline {
namespace {

constexpr double kMillimetres = 1000;  // in glTF's metre
// Range of a channel's attenuation over the attenuation distance, excluding opaque and lossless channels.
constexpr double kDarkest = 1e-6, kClearest = .999;
constexpr double kMostAnisotropy = .99;
constexpr double kLeastIor = 1, kMostIor = 10, kGltfIor = 1.5;

/// Scattering of a volume, in either spelling of the draft.
struct Scatter {
  Vec3d multiscatter_color;  ///< times the strength
  double anisotropy;
};

/// sigma_a and sigma_s over sigma_t.
struct Shares {
  double absorbed, scattered;
};

/// Single-scattering albedo of an index-matched half space with the reflectance `color` (Kulla & Conty 2017,
/// with van de Hulst's similarity for anisotropy), as in the glTF draft.
Shares single_scattering(double color, double g) {
  const double s = 4.09712 + 4.20863 * color - std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
  const double square = std::clamp(s * s, 0., 1.), scale = 1 / (1 - g * square);
  return {square * (1 - g) * scale, (1 - square) * scale};
}

Vec3d color_of(const GltfRecord& record, const char* key, const Vec3d& otherwise) {
  const std::vector<double> c = record.numbers(key, 3);
  return c.empty() ? otherwise : Vec3d(c[0], c[1], c[2]);
}

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// Colour, metalness and roughness from either of glTF's models.
struct BaseLayer {
  Vec3d color{1, 1, 1};
  double metalness = 1, roughness = 1, alpha = 1;
  GltfRecord color_texture, roughness_texture;  ///< as in a material, or without an index
  const char* color_texture_name;
};

BaseLayer metallic_roughness(const GltfRecord& pbr) {
  BaseLayer base{.metalness = pbr.number("metallicFactor", 1),
                 .roughness = pbr.number("roughnessFactor", 1),
                 .color_texture = pbr.record("baseColorTexture"),
                 .roughness_texture = pbr.record("metallicRoughnessTexture"),
                 .color_texture_name = "baseColorTexture"};
  if (const std::vector<double> c = pbr.numbers("baseColorFactor", 4); !c.empty())
    base.color = {c[0], c[1], c[2]}, base.alpha = c[3];
  return base;
}

/// Metalness and base colour equivalent to a diffuse and a specular colour: Khronos's conversion (glTF
/// repository, extensions/2.0/Archived/KHR_materials_pbrSpecularGlossiness).
BaseLayer specular_glossiness(const GltfRecord& model) {
  constexpr double kDielectric = .04, kLeast = 1e-6;
  const auto brightness = [](const Vec3d& c) {
    return std::sqrt(.299 * c.x * c.x + .587 * c.y * c.y + .114 * c.z * c.z);
  };
  BaseLayer base{.metalness = 0,
                 .roughness = 1 - model.number("glossinessFactor", 1),
                 .color_texture = model.record("diffuseTexture"),
                 .roughness_texture = model.record("none"),
                 .color_texture_name = "diffuseTexture"};
  Vec3d diffuse(1);
  if (const std::vector<double> c = model.numbers("diffuseFactor", 4); !c.empty())
    diffuse = {c[0], c[1], c[2]}, base.alpha = c[3];
  const Vec3d specular = color_of(model, "specularFactor", Vec3d(1));
  const double rest = 1 - max_component(specular), bright = brightness(specular);
  if (bright > kDielectric) {
    const double b = brightness(diffuse) * rest / (1 - kDielectric) + bright - 2 * kDielectric,
                 square = b * b - 4 * kDielectric * (kDielectric - bright);
    base.metalness = std::clamp((std::sqrt(std::max(square, 0.)) - b) / (2 * kDielectric), 0., 1.);
  }
  const double metalness = base.metalness, mix = metalness * metalness;
  const Vec3d of_diffuse = diffuse * (rest / (1 - kDielectric) / std::max(1 - metalness, kLeast));
  const Vec3d of_specular =
      (specular - Vec3d(kDielectric * (1 - metalness))) * (1 / std::max(metalness, kLeast));
  base.color = component_min(component_max(of_diffuse * (1 - mix) + of_specular * mix, Vec3d(0)), Vec3d(1));
  return base;
}

class MaterialTranslator {
 public:
  MaterialTranslator(const GltfModel& gltf, const MaterialUse& use, AssetScene& scene)
      : gltf_(gltf),
        json_(material_within_ranges(gltf, use.index, scene)),
        material_(gltf.path, record_name("materials", use.index), json_),
        extensions_(material_.record("extensions")),
        base_(has(kSpecularGlossiness) ? specular_glossiness(values(kSpecularGlossiness))
                                       : metallic_roughness(material_.record("pbrMetallicRoughness"))),
        use_(use),
        label_(material_label(gltf, use.index)),
        scene_(scene) {
    if (has(kSpecularGlossiness)) carried_.insert(base_.color_texture_name);
  }

  SurfaceTranslation run() {
    SurfaceTranslation surface;
    surface.reflectance = base_.color;
    if (const std::optional<Scatter> scatter = read_scatter()) surface.medium = make_medium(*scatter);
    if (surface.medium.is_null())
      add_opaque(surface);
    else
      add_entry(surface);
    const GltfRecord normal = material_.record("normalTexture");
    if (std::optional<Json> normals = texture(normal, "normalTexture")) {
      (*normals)["scale"] = normal.number("scale", 1);
      surface.keys["normal_map"] = std::move(*normals);
      translated("normalTexture: " + tangents());
    }
    add_emission(surface.keys);
    add_opacity(surface.keys, !surface.medium.is_null());
    tell_losses(!surface.medium.is_null());
    return surface;
  }

 private:
  void translated(const std::string& text) { scene_.translated.push_back(label_ + ": " + text); }
  void not_carried(const std::string& text) { scene_.not_carried.push_back(label_ + ": " + text); }

  void warn(const std::string& text) { scene_.warn(gltf_.path, label_ + ": " + text); }

  /// Warns of an index of a texture that does not exist.
  bool exists(const GltfRecord& info, const std::string& name) {
    const std::uint32_t index = info.index("index");
    if (index == kNoRecord || index < gltf_.count("textures")) return true;
    warn(name + ": " + record_name("textures", index) + " is not there");
    return false;
  }

  /// None: missing, or not supported.
  std::optional<Json> texture(const GltfRecord& info, const std::string& name) {
    if (info.index("index") == kNoRecord || !exists(info, name)) return {};
    if (!use_.has_uvs) {
      not_carried(name + ": its mesh has no " + uv_attribute(use_.uv_set));
      return {};
    }
    try {
      std::string warning;
      const bool is_color =
          name == base_.color_texture_name || name == "emissiveTexture" || name.ends_with("ColorTexture");
      Json json = texture_json(gltf_, info, use_.uv_set, use_.mesh_path, is_color, scene_.textures, warning);
      if (!warning.empty()) warn(name + ' ' + warning);
      translated(name + " -> " + json["texture"].get<std::string>());
      return json;
    } catch (const OutsideAsset&) {
      throw;
    } catch (const Error& failure) {
      if (failure.kind != ErrorKind::bad_input) throw;
      warn(name + ": " + failure.message + (failure.got.empty() ? "" : ": " + in_quotes(failure.got)));
      return {};
    }
  }

  std::string tangents() const {
    if (use_.has_tangents) return "around the mesh's TANGENT";
    return use_.has_uvs ? "around tangents of its UVs, not MikkTSpace's: its mesh has no TANGENT"
                        : "around y, because its mesh has no TEXCOORD_0";
  }

  /// A colour or number times its texture.
  static Json times(std::optional<Json> texture, Json factor, const Json& one) {
    if (!texture) return factor;
    if (factor != one) (*texture)["scale"] = std::move(factor);
    return *std::move(texture);
  }

  static constexpr std::array<const char*, 3> kChannels{"r", "g", "b"};
  static constexpr std::size_t kAlpha = 3;

  /// The channel of a number's texture: roughness is green, metalness blue.
  static std::optional<Json> channel(std::optional<Json> texture, const char* name) {
    if (texture) (*texture)["channel"] = name;
    return texture;
  }

  /// Texture of the base colour, and of alpha.
  std::optional<Json> color_texture() {
    std::optional<Json> colors = texture(base_.color_texture, base_.color_texture_name);
    if (colors && scene_.textures.back()->has_channel(kAlpha)) alphas_ = colors;
    return colors;
  }

  void add_opaque(SurfaceTranslation& surface) {
    const double metalness = base_.metalness, roughness = add_grain(surface.keys);
    surface.keys["reflectance"] =
        times(color_texture(), triple_json(surface.reflectance), triple_json(Vec3d(1)));
    const std::optional<Json> both = texture(base_.roughness_texture, "metallicRoughnessTexture");
    if (metalness > 0) surface.keys["metalness"] = times(channel(both, "b"), metalness, 1.0);
    surface.keys["specular_roughness"] = times(channel(both, "g"), roughness, 1.0);
    const double ior = index_of_refraction();
    if (ior != kGltfIor) surface.keys["specular_ior"] = ior;
    add_specular_weight(surface.keys);
    add_fuzz(surface.keys);
    translated(fmt::format("{} -> reflectance {}, metalness {:.3g}, specular_roughness {:.3g} (opaque)",
                           has(kSpecularGlossiness) ? "diffuseFactor, specularFactor, glossinessFactor"
                                                    : "baseColorFactor, metallicFactor, roughnessFactor",
                           short_triple(surface.reflectance), metalness, roughness));
  }

  /// Candela per square metre become W/(mm^2 sr), as the lux of the asset's lights become W/mm^2. An unusable texture
  /// leaves the surface dark: most of it usually is.
  void add_emission(Json& keys) {
    const double strength = values("KHR_materials_emissive_strength").number("emissiveStrength", 1);
    const Vec3d radiance = color_of(material_, "emissiveFactor", Vec3d(0)) * strength;
    if (radiance == Vec3d(0)) return;
    const GltfRecord info = material_.record("emissiveTexture");
    std::optional<Json> picture = texture(info, "emissiveTexture");
    if (!picture && info.index("index") != kNoRecord) return not_carried("emissiveFactor");
    keys["emission"] = times(std::move(picture), triple_json(radiance), triple_json(Vec3d(1)));
    translated("emissiveFactor -> emission " + short_triple(radiance));
  }

  /// Holes of an opaque surface; partial transparency becomes holes too.
  void add_opacity(Json& keys, bool is_translucent) {
    constexpr double kThreshold = kHoleOpacity;
    const std::string mode = material_.text("alphaMode", "OPAQUE");
    if (mode == "OPAQUE" || (!alphas_ && base_.alpha >= 1)) return;
    const double cutoff = mode == "MASK" ? material_.number("alphaCutoff", .5) : .5;
    const std::string label = "alphaMode " + in_quotes(mode);
    if (!alphas_ || is_translucent || keys.contains("emission"))
      return warn(label + fmt::format(": ignored, {} has no holes",
                                      is_translucent ? "a translucent body"
                                      : alphas_      ? "an emitting surface"
                                                     : "a surface without a texture of alpha"));
    if (!(cutoff > 0)) return;
    Json& opacity = keys["opacity"] = channel(alphas_, "a").value();
    if (const double scale = base_.alpha * kThreshold / cutoff; scale != 1) opacity["scale"] = scale;
    if (mode == "MASK")
      translated(fmt::format("{}, alphaCutoff {:.3g} -> opacity", label, cutoff));
    else
      warn(label + ": holes where alpha is below 0.5; partial transparency is not supported");
  }

  /// Keeps both alphas exact: returns the factor's roughness without anisotropy.
  double add_grain(Json& keys) {
    const double roughness = base_.roughness;
    const GltfRecord extension = values("KHR_materials_anisotropy");
    const double strength = extension.number("anisotropyStrength", 0);
    if (!(strength > 0)) return roughness;
    const double across = roughness * roughness, along = across + (1 - across) * strength * strength;
    const double anisotropy = 1 - across / along, rotation = extension.number("anisotropyRotation", 0);
    const double mean = std::sqrt(std::sqrt((along * along + across * across) / 2));
    const double degrees = std::remainder(rotation * 180 / std::numbers::pi, 360);
    const std::optional<Json> map = texture(extension.record("anisotropyTexture"), "anisotropyTexture");
    carried_.insert("anisotropyTexture");
    keys["specular_anisotropy"] = times(channel(map, "b"), anisotropy, 1.0);
    if (map) {
      keys["specular_rotation"] = channel(map, "rg").value();
      if (degrees != 0) not_carried("anisotropyRotation beside anisotropyTexture");
    } else if (degrees != 0) {
      keys["specular_rotation"] = degrees;
    }
    translated(
        fmt::format("anisotropyStrength {:.3g}, anisotropyRotation {:.3g}, roughnessFactor {:.3g} -> "
                    "specular_anisotropy {:.3g}, specular_rotation {:.4g}, specular_roughness {:.3g}; {}",
                    strength, rotation, roughness, anisotropy, degrees, mean, tangents()));
    if (base_.roughness_texture.index("index") != kNoRecord)
      not_carried(
          "anisotropyStrength where the roughness is not roughnessFactor: both alphas follow the texture");
    return mean;
  }

  /// The sheen's colour is the fibres' albedo, with its largest channel as the weight. A texture of it varies the
  /// weight; the fibres have its mean hue. Its lobe (Estevez & Kulla 2017) has another shape.
  void add_fuzz(Json& keys) {
    constexpr const char* kSheen = "KHR_materials_sheen";
    const GltfRecord sheen = values(kSheen);
    const Vec3d factor = color_of(sheen, "sheenColorFactor", Vec3d(0));
    if (!(max_component(factor) > 0)) return;
    Vec3d color = factor;
    std::optional<Json> weights = extension_texture(kSheen, "sheenColorTexture");
    if (weights) color = color * mean_color(*scene_.textures.back());
    std::size_t brightest = 0;
    for (std::size_t c = 1; c < 3; ++c)
      if (color[c] > color[brightest]) brightest = c;
    const double most = color[brightest], weight = factor[brightest];
    if (!(most > 0)) return;
    if (weights) {
      (*weights)["color_space"] = "srgb";
      const bool is_grey = !scene_.textures.back()->has_channel(brightest);
      weights = channel(std::move(weights), is_grey ? "r" : kChannels[brightest]);
    }
    const double roughness = sheen.number("sheenRoughnessFactor", 0);
    keys["fuzz_weight"] = times(std::move(weights), weight, 1.0);
    keys["fuzz_color"] = triple_json(color * (1 / most));
    keys["fuzz_roughness"] =
        times(channel(extension_texture(kSheen, "sheenRoughnessTexture"), "a"), roughness, 1.0);
    translated(
        fmt::format("sheenColorFactor {}, sheenRoughnessFactor {:.3g} -> fuzz_weight {:.3g}, fuzz_color {}, "
                    "fuzz_roughness",
                    short_triple(factor), roughness, weight, short_triple(color * (1 / most))));
  }

  static Vec3d mean_color(const TextureFile& texture) {
    const Texel mean = texture.mean();
    return component_max({mean[0], mean[1], mean[2]}, Vec3d(0));
  }

  void add_specular_weight(Json& keys) {
    if (!has("KHR_materials_specular")) return;
    const GltfRecord specular = values("KHR_materials_specular");
    const double weight = specular.number("specularFactor", 1);
    if (weight < 1) keys["specular_weight"] = weight;
    translated(fmt::format("specularFactor -> specular_weight {:.3g}", weight));
    const Vec3d color = color_of(specular, "specularColorFactor", Vec3d(1));
    if (color != Vec3d(1)) not_carried("specularColorFactor " + short_triple(color));
  }

  std::optional<Json> extension_texture(const char* extension, const char* key) {
    if (!values(extension).has(key)) return {};
    carried_.insert(key);
    return texture(values(extension).record(key), key);
  }

  /// A colour of the medium, unless it is white.
  void add_color(Json& medium, const char* key, std::optional<Json> picture, const Vec3d& factor,
                 const char* name) {
    if (!picture && factor == Vec3d(1)) return;
    medium[key] = times(std::move(picture), triple_json(factor), triple_json(Vec3d(1)));
    translated(fmt::format("{} -> {} {}", name, key, short_triple(factor)));
  }

  /// Transmitted light scatters inside: clear transmission in the base colour, or diffuse transmission in a
  /// colour of its own. The rest is reflected in the base colour. Without either, all light enters, as
  /// otherwise nothing would scatter.
  void add_entry(SurfaceTranslation& surface) {
    constexpr const char *kClear = "KHR_materials_transmission",
                         *kDiffuse = "KHR_materials_diffuse_transmission";
    const double clear = values(kClear).number("transmissionFactor", 0),
                 diffuse = values(kDiffuse).number("diffuseTransmissionFactor", 0);
    const double weight = clear + (1 - clear) * diffuse;
    const Vec3d color = color_of(values(kDiffuse), "diffuseTransmissionColorFactor", Vec3d(1));
    std::optional<Json> base = color_texture();
    std::optional<Json> share;
    if (diffuse == 0 && clear > 0) share = channel(extension_texture(kClear, "transmissionTexture"), "r");
    if (clear == 0 && diffuse > 0)
      share = channel(extension_texture(kDiffuse, "diffuseTransmissionTexture"), "a");
    if (weight == 0) {
      not_carried(
          "transmissionFactor 0 and diffuseTransmissionFactor 0: all light enters except the light "
          "reflected by the boundary");
    } else if (weight < 1 || share) {
      surface.medium["subsurface_weight"] = times(std::move(share), weight, 1.0);
      surface.medium["base_color"] = times(base, triple_json(surface.reflectance), triple_json(Vec3d(1)));
      translated(fmt::format(
          "transmissionFactor {:.3g}, diffuseTransmissionFactor {:.3g} -> subsurface_weight {:.3g}, the rest "
          "in base_color {}",
          clear, diffuse, weight, short_triple(surface.reflectance)));
    }
    if (diffuse > 0 && clear == 0) {
      add_color(surface.medium, "tint", extension_texture(kDiffuse, "diffuseTransmissionColorTexture"), color,
                "diffuseTransmissionColorFactor");
    } else {
      add_color(surface.medium, "tint", std::move(base), surface.reflectance, "baseColorFactor");
      if (color != Vec3d(1)) not_carried("diffuseTransmissionColorFactor " + short_triple(color));
    }
    add_specular_weight(surface.medium);
    add_fuzz(surface.medium);
    if (std::optional<Json> rough =
            channel(texture(base_.roughness_texture, "metallicRoughnessTexture"), "g"))
      surface.medium["specular_roughness"] =
          times(std::move(rough), surface.medium["specular_roughness"], 1.0);
  }

  bool has(const char* extension) const { return extensions_.has(extension); }
  GltfRecord values(const char* extension) const { return extensions_.record(extension); }

  std::optional<Scatter> read_scatter() const {
    if (has("KHR_materials_scatter")) {
      const GltfRecord scatter = values("KHR_materials_scatter");
      const double strength = scatter.number("scatterStrengthFactor", 1);
      return Scatter{color_of(scatter, "multiscatterColorFactor", Vec3d(1)) * strength,
                     scatter.number("scatterAnisotropy", 0)};
    }
    if (!has("KHR_materials_volume_scatter")) return std::nullopt;
    const GltfRecord scatter = values("KHR_materials_volume_scatter");
    return Scatter{color_of(scatter, "multiscatterColor", Vec3d(0)), scatter.number("scatterAnisotropy", 0)};
  }

  double index_of_refraction() {
    const double ior = values("KHR_materials_ior").number("ior", kGltfIor);
    if (ior >= kLeastIor && ior <= kMostIor) return ior;
    warn(fmt::format("ior {:.4g}, outside {} to {}: uses {}", ior, kLeastIor, kMostIor, kGltfIor));
    return kGltfIor;
  }

  /// Null without attenuation.
  Json make_medium(const Scatter& scatter) {
    const GltfRecord volume = values("KHR_materials_volume");
    const double distance = volume.number("attenuationDistance", std::numeric_limits<double>::infinity());
    const Vec3d color = color_of(volume, "attenuationColor", Vec3d(1));
    if (!(distance > 0) || !std::isfinite(distance) || color == Vec3d(1) ||
        scatter.multiscatter_color == Vec3d()) {
      warn(
          "scattering requires attenuationDistance, attenuationColor below 1 and a multiscatter "
          "colour; treated as opaque");
      return {};
    }
    if (color != clamped(color))
      not_carried(fmt::format("attenuationColor {} outside {} to {}: uses {}", short_triple(color), kDarkest,
                              kClearest, short_triple(clamped(color))));
    const double g = std::clamp(scatter.anisotropy, -kMostAnisotropy, kMostAnisotropy);
    Vec3d sigma_a, sigma_s;
    for (std::size_t i = 0; i < 3; ++i) {
      const double sigma_t = -std::log(clamped(color)[i]) / (distance * kMillimetres);
      const Shares shares = single_scattering(scatter.multiscatter_color[i], g);
      sigma_a[i] = shares.absorbed * sigma_t;
      sigma_s[i] = shares.scattered * sigma_t;
    }
    const double ior = index_of_refraction();
    Json medium = Json::object();
    const double roughness = add_grain(medium);
    translated(fmt::format(
        "attenuationColor {} over {:.4g} mm, multiscatter colour {}, anisotropy {:.3g}, ior {:.4g}, "
        "roughnessFactor {:.3g} -> sigma_a {}, sigma_s {} 1/mm, g {:.3g}, specular_ior {:.4g}, "
        "specular_roughness {:.3g}",
        short_triple(color), distance * kMillimetres, short_triple(scatter.multiscatter_color),
        scatter.anisotropy, ior, base_.roughness, short_triple(sigma_a), short_triple(sigma_s), g, ior,
        roughness));
    tell_of_thickness(volume);
    medium.update({{"sigma_a", triple_json(sigma_a)},
                   {"sigma_s", triple_json(sigma_s)},
                   {"g", g},
                   {"specular_ior", ior},
                   {"specular_roughness", roughness}});
    return medium;
  }

  static Vec3d clamped(const Vec3d& color) {
    return component_min(component_max(color, Vec3d(kDarkest)), Vec3d(kClearest));
  }

  void tell_of_thickness(const GltfRecord& volume) {
    const double thickness = volume.number("thicknessFactor", 0);
    if (thickness > 0)
      translated(fmt::format("thicknessFactor {:.4g} mm -> thickness of the mesh", thickness * kMillimetres));
    else
      not_carried("thicknessFactor 0 (thin-walled): the mesh is treated as a solid body");
  }

  void tell_losses(bool is_translucent) {
    const auto add = [this](const GltfRecord& owner, const std::string& name) {
      if (!carried_.contains(name) && exists(owner.record(name.c_str()), name))
        not_carried("texture " + name);
    };
    if (material_.record("occlusionTexture").index("index") != kNoRecord) add(material_, "occlusionTexture");
    for (const std::string& extension : extensions_.keys())
      for (const std::string& key : values(extension.c_str()).keys())
        if (key.ends_with("Texture")) add(values(extension.c_str()), key);
    tell_extensions(is_translucent);
  }

  bool transmits(const std::string& extension) const {
    const char* const factor =
        extension == "KHR_materials_transmission" ? "transmissionFactor" : "diffuseTransmissionFactor";
    return values(extension.c_str()).number(factor, 0) > 0;
  }

  void tell_extensions(bool is_translucent) {
    constexpr std::array<std::string_view, 3> of_volume{"KHR_materials_transmission", "KHR_materials_volume",
                                                        "KHR_materials_diffuse_transmission"};
    constexpr std::array<std::string_view, 8> read{
        kSpecularGlossiness,     "KHR_materials_anisotropy",       "KHR_materials_ior",
        "KHR_materials_sheen",   "KHR_materials_specular",         "KHR_materials_volume_scatter",
        "KHR_materials_scatter", "KHR_materials_emissive_strength"};
    for (const std::string& name : extensions_.keys()) {
      if (std::ranges::find(read, name) != read.end()) continue;
      if (std::ranges::find(of_volume, name) == of_volume.end())
        not_carried(name);
      else if (!is_translucent && transmits(name))
        warn(name + ": a clear, non-scattering body is not supported; treated as opaque");
      else if (!is_translucent)
        not_carried(name);
    }
  }

  const GltfModel& gltf_;
  Json json_;
  GltfRecord material_, extensions_;
  BaseLayer base_;
  std::optional<Json> alphas_;  // texture of the colour, if it has alpha
  const MaterialUse& use_;
  std::string label_;
  AssetScene& scene_;
  std::set<std::string> carried_;  // textures of extensions
};

}  // namespace

SurfaceTranslation translate_material(const GltfModel& gltf, const MaterialUse& use, AssetScene& scene) {
  if (use.index != kNoRecord) return MaterialTranslator(gltf, use, scene).run();
  scene.translated.push_back("no material -> reflectance 1 (opaque)");
  return {};
}

std::string material_label(const GltfModel& gltf, std::size_t index) {
  const std::string name = gltf.record("materials", index).text("name");
  return name.empty() ? record_name("materials", index) : "material " + in_quotes(name);
}

}  // namespace opaline
