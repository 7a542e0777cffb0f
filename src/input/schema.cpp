// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "image/solid_noise.h"
#include "input/key_rows.h"
#include "input/settings_table.h"
#include "lights/all_lights.h"
#include "scene/mesh_formats.h"
#include "spectra/spectrum.h"
#include "values/json_tree.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 5> kTextureChannels{"r", "g", "b", "a", "rg"};

std::string_view mesh_file_meaning() {
  static const std::string text = [] {
    std::string formats;
    for (std::size_t i = 0; i < kMeshFormats.size(); ++i) {
      if (i > 0) formats += i + 1 < kMeshFormats.size() ? ", " : " or ";
      formats += kMeshFormats[i];
    }
    return "mesh: " + formats + "; relative paths start at the scene file's folder";
  }();
  return text;
}

template <class Kind>
void add_light_rows(std::vector<KeyInfo>& rows) {
  static const std::string section = "light." + std::string(Kind::kType);
  std::vector<KeyInfo> keys = light_keys(Kind());
  if (keys.empty()) return;
  KeyInfo name{.key = "name",
               .type = ValueType::text,
               .default_value = "\"light0\", ...",
               .meaning = "name in layers, messages and `--set`"};
  keys.insert(keys.begin() + 1, std::move(name));
  if (Kind::kCanBeSeen)
    keys.push_back(
        {.key = "visible",
         .type = ValueType::flag,
         .default_value = "true",
         .meaning = "`false` hides it from the camera; it still emits light and appears in reflections"});
  for (KeyInfo& info : keys) {
    info.section = section;
    rows.push_back(std::move(info));
  }
}

template <class... Kinds>
std::vector<KeyInfo> light_rows(const std::variant<Kinds...>*) {
  std::vector<KeyInfo> rows;
  (add_light_rows<Kinds>(rows), ...);
  static std::vector<std::string_view> types;
  for (const KeyInfo& info : rows)
    if (info.key == "type") types.push_back(info.section.substr(info.section.find('.') + 1));
  for (KeyInfo& info : rows)
    if (info.key == "type") info.choices = types;
  return rows;
}

std::vector<KeyInfo> scene_rows() {
  using enum ValueType;
  return {
      row("scene", "mm_per_unit", number, "mm", {1e-12, 1e12}, "1", "length of one scene unit"),
      row("scene", "media", object, "", kFiniteNumber, "none",
          "translucent media: `{\"name\": {...}, ...}`, see medium"),
      row("scene", "shapes", list, "", kFiniteNumber, "none", "list of shapes, see shape"),
      row("scene", "lights", list, "", kFiniteNumber, "none", "list of lights, see light"),
      row("scene", "surroundings", color, "W/(mm² sr)", kNonNegative, "0 (black)",
          "constant radiance from every direction, as a light named \"surroundings\""),
      row("scene", "backdrop", color, "W/(mm² sr)", kNonNegative, "surroundings and environments",
          "constant radiance behind all shapes, in place of surroundings and environments; visible to the "
          "camera "
          "alone, it emits no light"),
      row("scene", "camera", object, "", kFiniteNumber, "see camera",
          "position, direction and angle of view"),
      row("scene", "film", object, "", kFiniteNumber, "see film",
          "resolution, sampling and colours of the image"),
      row("scene", "settings", object, "", kFiniteNumber, "see settings", "method, samples and accuracy"),
      row("scene", "$schema", text, "", kFiniteNumber, "none",
          "JSON Schema of the file, for an editor; opaline ignores it"),
  };
}

std::vector<KeyInfo> shape_rows() {
  using enum ValueType;
  const std::vector<KeyInfo> fuzz = fuzz_rows("shape");
  return {
      row("shape", "name", text, "", kFiniteNumber, "\"shape0\", \"shape1\", ...",
          "unique name in messages and `--set`"),
      row("shape", "file", file, "", kFiniteNumber, "", mesh_file_meaning()),
      row("shape", "part", text, "", kFiniteNumber, "all of the file",
          "with `file`: one part of it. GLB and glTF (required): the indices `\"mesh/primitive\"`, or "
          "`\"mesh/primitive/node\"` in the pose of that node, with `/instance` behind it for one of the "
          "node's instances. OBJ: the name of a material, for its faces"),
      row("shape", "sphere", object, "", kFiniteNumber, "", "built-in sphere, see below"),
      row("shape", "box", object, "", kFiniteNumber, "", "built-in box"),
      row("shape", "quad", object, "", kFiniteNumber, "", "built-in parallelogram"),
      row("shape", "slab", object, "", kFiniteNumber, "", "built-in plate"),
      row("shape", "torus", object, "", kFiniteNumber, "", "built-in torus"),
      row("shape", "fill_holes", flag, "", kFiniteNumber, "small holes of translucent shapes",
          "with `file`: closes every hole of the mesh, or none; light leaks through an open mesh. By "
          "default, the holes of a translucent shape are closed if each is below 5 %, and all are below "
          "10 % of its area"),
      row("shape", "fit_size", length, "", kFiniteNumber, "as it is in the file",
          "with `file`: scales the mesh until the largest side of its bounding box has this length, centres "
          "it on x = z = 0 and places it on y = 0, before `transform`"),
      row("shape", "transform", list, "", kFiniteNumber, "none", "list of steps, applied in order"),
      row("shape", "normals", choice, "", kFiniteNumber, "`\"smooth\"`",
          "`\"smooth\"`: normals of the file, or computed vertex normals with sharp creases; `\"faceted\"`: "
          "normals of the triangles",
          kNormalNames),
      row("shape", "crease_angle", number, "degrees", {0, 180},
          "STL: 30; OBJ: from its smoothing groups; others: 180",
          "with `file`, without normals: edges with a larger angle between their faces are sharp"),
      row("shape", "subdivide", whole_number, "", {0, MeshFile::kMostRounds}, "0",
          "with `file`: rounds of Loop subdivision of a coarse cage; each rounds the shape, with four times "
          "as "
          "many triangles. Normals and creases of the file are ignored; open borders become smooth curves"),
      row("shape", "animation_time", number, "s", kFiniteNumber, "at rest",
          "with `file`: pose of a glTF asset at this time of an animation. The transform of the asset's node "
          "is included, with those above it"),
      row("shape", "animation", text, "", kFiniteNumber, "the first",
          "with `animation_time`: name of the animation, or its index from 0"),
      row("shape", "visible", flag, "", kFiniteNumber, "true",
          "`false` hides it from the camera; it still casts shadows, reflects light and appears in "
          "reflections"),
      row("shape", "shadow_catcher", flag, "", kFiniteNumber, "false",
          "opaque shapes: the camera sees the background through it, darkened by the shadows of direct "
          "light; "
          "alpha is their opacity"),
      row("shape", "medium", text, "", kFiniteNumber, "opaque", "name of a medium"),
      textured(row("shape", "reflectance", color, "", kUnitInterval, "0.5",
                   "diffuse reflectance of an opaque shape, multiplied by `vertex_colors`; cannot be "
                   "combined with `medium`")),
      textured(row("shape", "emission", color, "W/(mm² sr)", kNonNegative, "0",
                   "radiance emitted by the surface, on its outer side, besides the light it reflects or "
                   "transmits; a light named as the shape. Texels are multiplied by `scale`")),
      row("shape", "vertex_colors", flag, "", kFiniteNumber, "true; false under a texture",
          "with `file`: vertex colours are the reflectance of an opaque shape, multiplied by `reflectance` "
          "if given; they multiply a medium's `tint` and `base_color`"),
      textured(row("shape", "metalness", number, "", kUnitInterval, "0",
                   "opaque shapes: 1: metal with the specular colour `reflectance`, 0: dielectric; makes the "
                   "shape glossy")),
      textured(row("shape", "specular_roughness", number, "", kUnitInterval, "diffuse; with `metalness`: 1",
                   "opaque shapes: roughness of the specular reflection: 0 smooth, 0.3 satin; makes the "
                   "shape glossy")),
      row("shape", "specular_ior", number, "", {.1, 10}, "1.5",
          "glossy opaque shapes: index of refraction of the dielectric boundary"),
      row("shape", "specular_weight", number, "", {0, 1}, "1",
          "glossy opaque shapes: factor of the dielectric's specular reflectance at normal incidence; metals "
          "ignore it"),
      textured(row("shape", "specular_anisotropy", number, "", kUnitInterval, "0", kAnisotropyMeaning)),
      textured(row("shape", "specular_rotation", number, "degrees", {-360, 360}, "0", kRotationMeaning)),
      fuzz[0],
      fuzz[1],
      fuzz[2],
      textured(row("shape", "normal_map", object, "", kFiniteNumber, "none",
                   "tangent-space normal map: red right, green up, blue out, 0 to 1 for -1 to 1; `scale` "
                   "multiplies the slopes")),
      textured(row("shape", "bump_map", object, "", kFiniteNumber, "none",
                   "height map that perturbs the normals, after `normal_map`; does not displace the surface. "
                   "Heights are the texture times `scale`, in scene units, regardless of `transform`")),
      textured(row("shape", "displacement", object, "", kFiniteNumber, "none",
                   "height map that moves the vertices along their smooth normals, after `subdivide` and "
                   "`transform`; the normals follow. Heights are the texture times `scale`, in scene units; "
                   "the mesh limits the detail")),
      textured(row("shape", "opacity", object, "", kFiniteNumber, "none",
                   "opaque shapes that do not emit: texture with UVs; the surface has holes where it is "
                   "below 0.5, such as around "
                   "leaves. Usually with `\"channel\": \"a\"`; `scale` moves the threshold")),
      row("shape", "group", text, "", kFiniteNumber, "alone",
          "translucent shapes of one group are one body, with one medium; light does not scatter from one "
          "body to another"),
  };
}

std::vector<KeyInfo> built_in_shape_rows() {
  using enum ValueType;
  return {
      row("shape.sphere", "center", point, "", kFiniteNumber, "[0, 0, 0]", "centre"),
      row("shape.sphere", "radius", length, "", kFiniteNumber, "", "radius"),
      row("shape.box", "low", point, "", kFiniteNumber, "", "corner with the smallest x, y and z"),
      row("shape.box", "high", point, "", kFiniteNumber, "",
          "corner with the largest x, y and z; greater than `low` in all three"),
      row("shape.quad", "corner", point, "", kFiniteNumber, "", "one corner"),
      row("shape.quad", "u", point, "", kFiniteNumber, "", "vector from the corner along one side"),
      row("shape.quad", "v", point, "", kFiniteNumber, "",
          "vector from the corner along the other side, not parallel to `u`; u x v points to the front"),
      row("shape.slab", "center", point, "", kFiniteNumber, "[0, 0, 0]", "centre"),
      row("shape.slab", "width", length, "", kFiniteNumber, "", "extent along x"),
      row("shape.slab", "depth", length, "", kFiniteNumber, "", "extent along z"),
      row("shape.slab", "thickness", length, "", kFiniteNumber, "", "extent along y"),
      row("shape.torus", "center", point, "", kFiniteNumber, "[0, 0, 0]", "centre"),
      row("shape.torus", "major_radius", length, "", kFiniteNumber, "",
          "distance from the centre to the middle of the tube"),
      row("shape.torus", "minor_radius", length, "", kFiniteNumber, "",
          "radius of the tube; less than `major_radius`"),
      row("shape.transform", "translate", point, "", kFiniteNumber, "", "translates by [x, y, z]"),
      row("shape.transform", "scale", number_or_triple, "not 0", kFiniteNumber, "",
          "scales about the origin, by one number or [x, y, z]; negative numbers mirror"),
      row("shape.transform", "rotate", object, "", kFiniteNumber, "",
          "rotates about an axis through the origin, see below"),
      row("shape.transform", "matrix", list, "last column in scene units", kFiniteNumber, "",
          "three rows of four numbers; the last column translates"),
      row("shape.transform.rotate", "axis", triple, "", kFiniteNumber, "",
          "[x, y, z], of any nonzero length"),
      row("shape.transform.rotate", "degrees", number, "degrees", kFiniteNumber, "",
          "angle, counter-clockwise when the axis points towards the viewer"),
  };
}

std::vector<KeyInfo> camera_rows() {
  using enum ValueType;
  return {
      row("camera", "position", point, "", kFiniteNumber, "[0, 0, 5]", "position of the camera"),
      row("camera", "look_at", point, "", kFiniteNumber, "[0, 0, 0]", "point at the centre of the image"),
      row("camera", "up", triple, "", kFiniteNumber, "[0, 1, 0]",
          "up direction of the image; not parallel to the view direction"),
      row("camera", "field_of_view", number, "degrees", {0, 180, true, true}, "40",
          "full vertical angle of view"),
      row("camera", "orthographic_height", length, "", kFiniteNumber, "none",
          "parallel projection of this height, in place of `field_of_view`"),
      row("camera", "shift", list, "", {-10, 10}, "[0, 0]",
          "moves the view to the right and up, in widths and heights of the image; vertical lines stay "
          "parallel"),
      row("camera", "aperture", number, "scene units", kNonNegative, "0",
          "depth of field: diameter of the lens; use several `samples_per_pixel`"),
      row("camera", "f_number", number, "", {0, 1e30, true}, "none",
          "the same in place of `aperture`, for a film of 36 x 24 mm and lengths in true size"),
      row("camera", "focus_distance", length, "", kFiniteNumber, "that of `look_at`",
          "distance of the plane in focus"),
      row("camera", "focus_point", point, "", kFiniteNumber, "none",
          "point of the plane in focus, in place of `focus_distance`; no effect behind the camera"),
      row("camera", "blades", whole_number, "", {0, 100}, "0",
          "blades of the iris, for the shape of blurred highlights; 0: round"),
  };
}

std::vector<KeyInfo> texture_rows() {
  using enum ValueType;
  return {
      row("texture", "texture", file, "", kFiniteNumber, "",
          "EXR, HDR, PNG, JPEG, TIFF or WebP, relative to the scene file's folder. `<UDIM>` in the name "
          "stands for "
          "1001 + column + 10 x row. `asset.glb#image/0` is an image of an asset. Colours are converted from "
          "the chromaticities of an EXR to Rec.709; premultiplied colours are divided by alpha"),
      row("texture", "noise", choice, "", kFiniteNumber, "",
          "a pattern in the space of the shape in place of an image, without UVs: `\"clouds\"`, or "
          "`\"veins\"` on "
          "thin sheets",
          kNoisePatternNames),
      row("texture", "size", length, "", kFiniteNumber, "", "of the largest features of `noise`"),
      row("texture", "octaves", whole_number, "", {1, 12}, "5",
          "number of sizes of `noise`, each half of the one before"),
      row("texture", "low", number_or_triple, "", kNonNegative, "0",
          "one end of the values of `noise`; three numbers are linear red, green and blue"),
      row("texture", "high", number_or_triple, "", kNonNegative, "1", "the other end: that of the veins"),
      row("texture", "seed", whole_number, "", {0, 1e9}, "0", "another pattern of `noise` for each number"),
      row("texture", "triplanar", length, "", kFiniteNumber, "none",
          "width of the image, projected along the three axes of the shape and blended by the normal, "
          "without UVs"),
      row("texture", "color_space", choice, "", kFiniteNumber, "`\"automatic\"`",
          "`\"srgb\"` or `\"linear\"`; automatic: linear for float files and non-colour values, otherwise "
          "sRGB",
          kColorSpaceNames),
      row("texture", "scale", number_or_triple, "", kNonNegative, "1", "factor of the values"),
      row("texture", "channel", choice, "", kFiniteNumber, "`\"r\"`",
          "channel used for a number: `\"r\"`, `\"g\"`, `\"b\"` or `\"a\"`; `\"rg\"`: the direction of "
          "`specular_rotation`",
          kTextureChannels),
      row("texture", "uv_scale", list, "", kFiniteNumber, "[1, 1]",
          "repeats to the right and down, from the upper left corner"),
      row("texture", "uv_rotation", number, "degrees", kFiniteNumber, "0",
          "rotates the UVs about that corner, after `uv_scale`"),
      row("texture", "uv_offset", list, "", kFiniteNumber, "[0, 0]",
          "moves the UVs right and down, after `uv_rotation`"),
      row("texture", "detail", list, "", kFiniteNumber, "none",
          "colours and normal maps: textures of finer detail, such as pores. Colours are combined by "
          "`blend`; "
          "normals are tilted further"),
      row("texture", "blend", choice, "", kFiniteNumber, "`\"relative\"`",
          "in the `detail` of a colour: `\"relative\"`: each texel over the mean of its texture is a factor; "
          "`\"overlay\"`: texels above 0.5 brighten, those below darken, which changes the mean. Overlays "
          "are "
          "linear by default and precede `scale`",
          kDetailBlendNames),
  };
}

std::vector<KeyInfo> spectrum_rows() {
  using enum ValueType;
  return {
      row("spectrum", "nm", list, "nm", {1, 1e5}, "",
          "increasing wavelengths, with `values`; linear between them, constant beyond"),
      row("spectrum", "values", list, "", kFiniteNumber, "",
          "a value for each; a light's are relative: 1 at every wavelength has the luminance of the colour "
          "1"),
      row("spectrum", "spectrum", file, "", kFiniteNumber, "",
          "text file with a wavelength in nm and a value per line, in place of `nm` and `values`, below "
          "at most one line of headings; `#` begins a comment"),
      row("spectrum", "blackbody", number, "K", {200, 1e6}, "",
          "lights: a black body of this temperature, with the luminance of the colour 1"),
      row("spectrum", "illuminant", choice, "", kFiniteNumber, "",
          "lights: `\"D65\"` (daylight, as the colour 1), `\"A\"` (light bulb), `\"FL2\"` (fluorescent) or "
          "`\"E\"` (equal energy), with the luminance of the colour 1",
          kIlluminantNames),
      row("spectrum", "tissue", object, "", kFiniteNumber, "",
          "`sigma_a`: living tissue by its pigments (Donner & Jensen 2006)"),
      row("spectrum", "powers", list, "", kFiniteNumber, "",
          "coefficients of media: list of `[factor, exponent]`; the sum of factor times wavelength in nm to "
          "the "
          "exponent"),
      row("spectrum", "scale", number, "", kNonNegative, "1", "factor of the values"),
      row("spectrum", "lm", number, "lm", kNonNegative, "",
          "lights of a position: luminous flux, in place of `scale` and of values in W; without a spectrum, "
          "white"),
      row("spectrum", "cd", number, "cd", kNonNegative, "", "`intensity`: luminous intensity, likewise"),
      row("spectrum", "lx", number, "lx", kNonNegative, "", "`irradiance`: illuminance, likewise"),
      row("spectrum", "nit", number, "cd/m²", kNonNegative, "",
          "`radiance` and `surroundings`: luminance, likewise"),
      row("spectrum", "color", color, "", kNonNegative, "white",
          "colour of the light with `lm`, `cd`, `lx` or `nit`"),
      row("spectrum.tissue", "melanin", number, "", kUnitInterval, "0",
          "fraction of the volume that is melanin: the epidermis of light skin 0.01 to 0.06, of dark skin "
          "0.2 to 0.4"),
      row("spectrum.tissue", "eumelanin", number, "", kUnitInterval, "0.7",
          "fraction of the melanin that is brown eumelanin; the rest is red pheomelanin"),
      row("spectrum.tissue", "blood", number, "", kUnitInterval, "0",
          "fraction of the volume that is blood: the dermis 0.002 to 0.07"),
      row("spectrum.tissue", "oxygenation", number, "", kUnitInterval, "0.75",
          "fraction of the haemoglobin with oxygen"),
  };
}

std::vector<KeyInfo> all_rows() {
  std::vector<KeyInfo> rows = scene_rows();
  for (const MediumRow& row : medium_rows()) rows.push_back(row.info);
  for (const auto& part : {shape_rows(), built_in_shape_rows(), texture_rows(), spectrum_rows(),
                           light_rows(static_cast<const LightSource*>(nullptr)), camera_rows()})
    rows.insert(rows.end(), part.begin(), part.end());
  for (const Member<Film>& member : film_members()) rows.push_back(member.info);
  for (const Member<Settings>& member : settings_members()) rows.push_back(member.info);
  for (const Member<Laboratory>& member : laboratory_members()) rows.push_back(member.info);
  return rows;
}

}  // namespace

std::span<const KeyInfo> schema() {
  static const std::vector<KeyInfo> rows = all_rows();
  return rows;
}

const KeyInfo& key_info(std::string_view section, std::string_view key) {
  const auto row = std::ranges::find_if(
      schema(), [&](const KeyInfo& info) { return info.section == section && info.key == key; });
  require(row != schema().end(), "a key of the scene's schema");
  return *row;
}

std::span<const std::string_view> file_keys() {
  static const std::vector<std::string_view> keys = [] {
    std::set<std::string_view> found;
    for (const KeyInfo& info : schema())
      if (info.type == ValueType::file) found.insert(info.key);
    return std::vector<std::string_view>(found.begin(), found.end());
  }();
  return keys;
}

std::span<const std::string_view> section_keys(std::string_view section) {
  static const std::map<std::string_view, std::vector<std::string_view>> sections = [] {
    std::map<std::string_view, std::vector<std::string_view>> keys;
    for (const KeyInfo& info : schema()) keys[info.section].push_back(info.key);
    return keys;
  }();
  const auto found = sections.find(section);
  return found == sections.end() ? std::span<const std::string_view>() : found->second;
}

bool may_be_spectrum(const KeyInfo& info) {
  return (info.type == ValueType::color && info.section != "spectrum") ||
         (info.type == ValueType::number_or_triple && info.section == "medium");
}

std::string settings_path(std::string_view key) {
  const bool is_laboratory = std::ranges::count(section_keys("settings.laboratory"), key) > 0;
  return fmt::format("settings.{}{}", is_laboratory ? "laboratory." : "", key);
}

}  // namespace opaline
