// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <utility>

#include "input/presets.h"
#include "input/readers.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 6> source_names{"file", "sphere", "box", "quad", "slab", "torus"};

MeshFile read_mesh_file(const ObjectReader& shape, const ShapeContext& context) {
  MeshFile mesh;
  mesh.path = shape.need("file").file_path();
  if (const auto part = shape.find("part")) mesh.part = part->string();
  if (const auto fill_holes = shape.find("fill_holes")) mesh.fill_holes = fill_holes->flag();
  if (const auto fit_size = shape.find("fit_size")) mesh.fit_size = fit_size->length(context.mm_per_unit);
  if (const auto colors = shape.find("vertex_colors")) mesh.vertex_colors = colors->flag();
  if (const auto crease = shape.find("crease_angle")) mesh.crease_angle = crease->number();
  if (const auto rounds = shape.find("subdivide")) mesh.subdivide = int(rounds->whole_number());
  const auto animation = shape.find("animation"), time = shape.find("animation_time");
  if (time && mesh.fit_size)
    time->fail_key("cannot be combined with 'fit_size', which would scale each pose to one size",
                   "a \"scale\" in 'transform', or 'mm_per_unit'");
  if (time) mesh.pose = AnimationTime{animation ? animation->string() : "", time->number()};
  return mesh;
}

Vec3d read_center(const ObjectReader& reader, double mm_per_unit) {
  const auto center = reader.find("center");
  return center ? center->point(mm_per_unit) : Vec3d{};
}

SphereShape read_sphere(const ObjectReader& reader, double mm_per_unit) {
  return {read_center(reader, mm_per_unit), reader.need("radius").length(mm_per_unit)};
}

BoxShape read_box(const ObjectReader& reader, double mm_per_unit) {
  const Value high_value = reader.need("high");
  const Vec3d low = reader.need("low").point(mm_per_unit), high = high_value.point(mm_per_unit);
  if (min_component(high - low) <= 0) high_value.fail("is not beyond 'low'", "more than 'low' in x, y and z");
  return {low, high};
}

QuadShape read_quad(const ObjectReader& reader, double mm_per_unit) {
  const Value v_value = reader.need("v");
  const Vec3d u = reader.need("u").point(mm_per_unit), v = v_value.point(mm_per_unit);
  check_parallelogram(u, v, v_value);
  return {reader.need("corner").point(mm_per_unit), u, v};
}

SlabShape read_slab(const ObjectReader& reader, double mm_per_unit) {
  return {read_center(reader, mm_per_unit), reader.need("width").length(mm_per_unit),
          reader.need("depth").length(mm_per_unit), reader.need("thickness").length(mm_per_unit)};
}

TorusShape read_torus(const ObjectReader& reader, double mm_per_unit) {
  const Value minor_value = reader.need("minor_radius");
  const double major = reader.need("major_radius").length(mm_per_unit),
               minor = minor_value.length(mm_per_unit);
  if (minor >= major) minor_value.fail("leaves no hole in the torus", "less than 'major_radius'");
  return {read_center(reader, mm_per_unit), major, minor};
}

/// place: set to the source's position in the file.
ShapeSource read_source(const ObjectReader& shape, const ShapeContext& context, SourcePlace& place) {
  const std::string_view kind = shape.exactly_one_of(source_names);
  place = shape.need(kind).place();
  if (kind == "file") return read_mesh_file(shape, context);
  for (const std::string_view option : {"part", "fill_holes", "fit_size", "vertex_colors", "crease_angle",
                                        "subdivide", "animation", "animation_time"})
    if (const auto value = shape.find(option)) value->fail_key("has no effect without 'file'");
  const ObjectReader source(shape.need(kind), "shape." + std::string(kind));
  const double mm_per_unit = context.mm_per_unit;
  if (kind == "sphere") return read_sphere(source, mm_per_unit);
  if (kind == "box") return read_box(source, mm_per_unit);
  if (kind == "quad") return read_quad(source, mm_per_unit);
  if (kind == "slab") return read_slab(source, mm_per_unit);
  return read_torus(source, mm_per_unit);
}

/// The option for a preset in place of the value of an override, "--set shapes.SHAPE.medium=NAME".
std::string medium_option(const Value& value, const std::string& preset) {
  const std::string given = value.place().file, shapes = "shapes.", medium = ".medium=";
  const std::size_t begin = given.find(shapes), end = given.rfind(medium);
  std::string shape;
  if (begin < end && end != given.npos)
    shape = given.substr(begin + shapes.size(), end - begin - shapes.size());
  return "--medium " + (shape.empty() || shape == "*" ? preset : shape + '=' + preset);
}

/// Fails with advice if a missing medium has the name of a preset, or a similar one.
void fail_if_preset(const Value& value, const std::string& name) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  const auto hint_at = [&](const std::string_view& preset) { return did_you_mean(name, {&preset, 1}); };
  auto found = std::ranges::find(names, name);
  const bool is_exact = found != names.end();
  if (!is_exact)
    found = std::ranges::find_if(names, [&](const auto& preset) { return !hint_at(preset).empty(); });
  if (found == names.end()) return;
  const std::string preset(*found),
      text = "is not a medium of this scene" + (is_exact ? "" : hint_at(*found));
  if (value.node().override_index >= 0) value.fail(text + ": use " + medium_option(value, preset));
  value.fail(text + ": '" + preset + "' is a preset: write \"media\": {\"" + preset + "\": {\"preset\": \"" +
             preset + "\"}}");
}

std::size_t find_medium(const Value& value, const std::vector<Medium>& media) {
  const std::string name = value.string();
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < media.size(); ++i) {
    if (media[i].name == name) return i;
    names.push_back(media[i].name);
  }
  const std::string hint = did_you_mean(name, names);
  if (hint.empty()) fail_if_preset(value, name);
  std::string expected =
      names.empty() ? "a name from 'media', which is empty" : "one of " + printable(join(names));
  if (value.node().override_index >= 0) {
    names.clear();
    for (const Preset& preset : presets()) names.push_back(preset.name);
    expected += ", or with --medium a preset: " + join(names);
  }
  value.fail("is not a medium of this scene" + hint, expected);
}

void read_gloss(const ObjectReader& reader, Shape& shape) {
  const auto metalness = reader.find("metalness"), roughness = reader.find("specular_roughness"),
             ior = reader.find("specular_ior"), weight = reader.find("specular_weight");
  const auto anisotropy = reader.find("specular_anisotropy"), rotation = reader.find("specular_rotation");
  for (const auto& key : {metalness, roughness, ior, weight, anisotropy, rotation})
    if (key && shape.medium) key->fail_key("belongs to the medium", "the key in 'media', or an opaque shape");
  for (const auto& key : {ior, weight, anisotropy, rotation})
    if (key && !metalness && !roughness)
      key->fail_key("has no effect on a diffuse shape", "'specular_roughness' with it");
  if (!metalness && !roughness) return;
  Gloss& gloss = shape.gloss.emplace();
  if (metalness) read_textured(*metalness, gloss.metalness, gloss.metalness_texture);
  if (roughness) read_textured(*roughness, gloss.roughness, gloss.roughness_texture);
  gloss.grain = read_grain(reader);
  if (ior) gloss.eta = ior->number();
  constexpr double kTrace = 1e-4;  // minimum weight of the dielectric, so metals keep a boundary
  if (weight) gloss.eta = weighted_ior(gloss.eta, std::max(weight->number(), kTrace));
}

/// Adds the light of an emitting shape.
/// in    shape: complete otherwise
void read_emission(const Value& value, ShapeContext& context, Shape& shape) {
  ShapeLight light{.shape = context.shapes_read};
  read_textured(value, light.radiance, shape.emission_texture);
  if (shape.emission_texture) light.radiance = take_mean(*shape.emission_texture);
  // At some wavelengths of a spectrum it may be black, but scenes of all wavelengths have the same lights.
  if (light.radiance == Rgb{} && value.wavelengths() == nullptr) return shape.emission_texture.reset();
  if (shape.catches_shadows) value.fail_key("cannot be combined with 'shadow_catcher'", "one of them");
  const std::size_t channels = shape.emission_texture ? 3 : 1;
  for (std::size_t c = 0; c < channels; ++c) {
    if (channels > 1) light.channel = c;
    context.lights.push_back({shape.name, light, value.place(), shape.is_seen});
  }
}

void read_surface(const ObjectReader& reader, ShapeContext& context, Shape& shape) {
  const auto medium = reader.find("medium"), reflectance = reader.find("reflectance");
  const auto group = reader.find("group");
  if (medium && reflectance)
    reflectance->fail_key("cannot be combined with 'medium'", "either a translucent or an opaque shape");
  if (medium) shape.medium = find_medium(*medium, *context.media);
  if (reflectance) {
    read_textured(*reflectance, shape.reflectance, shape.reflectance_texture);
    shape.has_reflectance = true;
  }
  if (const auto map = reader.find("normal_map")) shape.normal_map = read_normal_map(*map);
  if (const auto map = reader.find("bump_map")) shape.bump_map = read_bump_map(*map, context.mm_per_unit);
  if (const auto map = reader.find("displacement"))
    shape.displacement = read_displacement(*map, context.mm_per_unit);
  if (const auto map = reader.find("opacity")) {
    if (shape.medium) map->fail_key("cannot be combined with 'medium'", "an opaque shape");
    if (reader.find("emission")) map->fail_key("cannot be combined with 'emission'", "one of them");
    shape.opacity = read_opacity(*map);
  }
  read_gloss(reader, shape);
  for (const std::string_view name : {"fuzz_weight", "fuzz_color", "fuzz_roughness"})
    if (const auto key = reader.find(name); key && shape.medium)
      key->fail_key("belongs to the medium", "the key in 'media', or an opaque shape");
  shape.fuzz = read_fuzz(reader);
  if (!group) return;
  shape.group = group->string();
  if (!medium) group->fail_key("has no effect without 'medium'");
  const auto [first, is_new] = context.group_media.try_emplace(shape.group, *shape.medium);
  if (!is_new && first->second != *shape.medium)
    group->fail("contains two media", "the medium of the first shape of the group, '" +
                                          printable((*context.media)[first->second].name) + "'");
}

}  // namespace

void check_parallelogram(const Vec3d& u, const Vec3d& v, const Value& v_value) {
  // Normalised first: the product of very long or short vectors would over- or underflow.
  if (length(cross(normalized(u), normalized(v))) < 1e-9)
    v_value.fail("spans no area", "not parallel to 'u'");
}

Shape read_shape(const Value& value, const std::string& name, ShapeContext& context) {
  const ObjectReader reader(value, "shape");
  Shape shape;
  const auto own_name = reader.find("name"), transform = reader.find("transform"),
             normals = reader.find("normals");
  shape.name = own_name ? own_name->string() : name;
  shape.source = read_source(reader, context, shape.place);
  if (transform) shape.to_world = read_transform(*transform, context.mm_per_unit);
  // A mesh file without a size in mm is in scene units.
  auto* mesh = std::get_if<MeshFile>(&shape.source);
  if (mesh != nullptr && !mesh->fit_size) {
    mesh->mm_per_unit = context.mm_per_unit;
    for (Vec3d* axis : {&shape.to_world.x, &shape.to_world.y, &shape.to_world.z})
      *axis *= context.mm_per_unit;
  }
  if (normals) shape.normals = static_cast<NormalMode>(normals->choice());
  read_surface(reader, context, shape);
  if (const auto visible = reader.find("visible")) shape.is_seen = visible->flag();
  if (const auto catcher = reader.find("shadow_catcher")) {
    shape.catches_shadows = catcher->flag();
    if (shape.catches_shadows && shape.medium)
      catcher->fail_key("cannot be combined with 'medium'", "an opaque shape");
  }
  if (const auto emission = reader.find("emission")) read_emission(*emission, context, shape);
  ++context.shapes_read;
  return shape;
}

}  // namespace opaline
