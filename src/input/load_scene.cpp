// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <set>
#include <vector>

#include "assets/import_asset.h"
#include "core/input_file.h"
#include "diffusion/diffuse_profile.h"
#include "geometry/world.h"
#include "image/texture_file.h"
#include "input/deprecated_spellings.h"
#include "input/edited_text.h"
#include "input/keyed_values.h"
#include "input/overrides.h"
#include "input/photometric_values.h"
#include "input/readers.h"
#include "input/spectral_values.h"
#include "lights/environment_picture.h"
#include "scene/same_place.h"
#include "scene/scene_properties.h"
#include "scene/unread_format.h"
#include "spectra/wavelengths.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

constexpr std::size_t largest_file = std::size_t{64} << 20;  // bytes

std::string read_text(const std::string& path) {
  const InputFile file(path, "scene file", did_you_mean_file);
  if (file.size() > largest_file) throw bad_file(path, "too large for a scene file", "at most 64 MiB");
  return file.read_all();
}

/// Rejects images, and unsupported formats.
void check_is_no_other_file(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  for (const char* picture : {".png", ".exr", ".hdr", ".jpg", ".jpeg", ".tif"})
    if (extension == picture)
      throw bad_file(path, "is an image, not a scene",
                     "a scene file (JSON), or an asset: .glb, .gltf, .obj, .ply, .stl or .off");
  if (const std::string unread = unread_format(path); !unread.empty()) throw bad_file(path, unread);
}

/// Assets are recognised by their extension.
void check_begins_as_scene(const std::string& path, const std::string& text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw bad_file(path, "is UTF-16", "a scene file in UTF-8");
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string::npos || text[first] == '{' || text[first] == '/') return;
  throw bad_file(path, "is not a scene file",
                 "JSON that begins with '{', or an asset with a name that ends in .glb, .gltf, .obj, .ply, "
                 ".stl or .off");
}

/// Reads the elements of a list, and rejects a name used twice.
template <class T, class Read>
std::vector<T> read_named(const std::optional<Value>& list, const std::string& default_name, Read read) {
  std::vector<T> records;
  std::set<std::string> names;
  if (!list) return records;
  for (const Value& value : list->list()) {
    records.push_back(read(value, default_name + std::to_string(records.size())));
    const std::string& name = records.back().name;
    if (names.insert(name).second) continue;
    if (const std::optional<Value> own = value.member("name", value.info()))
      own->fail("is already in use", "a unique name");
    value.fail("has a default name that is already in use: '" + printable(name) + "'");
  }
  return records;
}

/// Splits coloured environment maps into a light per channel, as irradiance is one number per light.
std::vector<Light> by_channel(const std::vector<Light>& lights) {
  std::vector<Light> split;
  for (const Light& light : lights) {
    const auto* environment = std::get_if<EnvironmentLight>(&light.source);
    if (environment == nullptr || environment->picture->is_grey()) {
      split.push_back(light);
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      EnvironmentLight channel = *environment;
      channel.channel = c;
      split.push_back({light.name, channel, light.place, light.is_seen});
    }
  }
  return split;
}

/// A light of a shape has the shape's name, with an addition if another light has it.
void add_lights_of_shapes(const std::vector<Light>& emitted, std::vector<Light>& lights) {
  std::set<std::string> names{"surroundings"};
  for (const Light& light : lights) names.insert(light.name);
  for (Light light : emitted) {
    while (names.contains(light.name)) light.name += " emission";
    lights.push_back(std::move(light));
  }
}

void read_surroundings(const Value& value, std::vector<Light>& lights) {
  const Rgb radiance = value.color();
  if (radiance != Rgb{}) lights.push_back({"surroundings", Surroundings{radiance}, value.place()});
}

/// Distributes triangles over spheres. A few have the maximum, limited by the precision of float vertices.
/// More have a quarter each, with 0.02 % less area; hundreds share the memory of one hundred.
void share_triangles(std::vector<Shape>& shapes) {
  constexpr double kMostTriangles = 8e6, kFinestTriangles = 81920, kFewBalls = 6;
  const auto for_each_curved = [&](const auto& use) {
    for (Shape& shape : shapes) {
      if (auto* sphere = std::get_if<SphereShape>(&shape.source)) use(sphere->fineness);
      if (auto* torus = std::get_if<TorusShape>(&shape.source)) use(torus->fineness);
    }
  };
  double balls = 0;
  for_each_curved([&](int&) { ++balls; });
  double triangles = balls * kFinestTriangles;
  int fineness = kMostFineness;
  if (balls > kFewBalls) {
    --fineness;
    triangles /= 4;
  }
  for (; fineness > kLeastFineness && triangles > kMostTriangles; triangles /= 4) --fineness;
  for_each_curved([&](int& of_shape) { of_shape = fineness; });
}

/// A multipole medium without a thickness has that of the built-in plates made of it.
/// error if they differ
void take_thickness_of_plates(Scene& scene) {
  std::vector<bool> is_declared;
  for (const Medium& medium : scene.media) is_declared.push_back(std::isfinite(medium.thickness));
  for (const Shape& shape : scene.shapes) {
    const auto* plate = std::get_if<SlabShape>(&shape.source);
    if (plate == nullptr || !shape.medium || is_declared[*shape.medium]) continue;
    Medium& medium = scene.media[*shape.medium];
    if (medium.profile != ProfileKind::multipole) continue;
    const double thickness = plate->thickness * length(shape.to_world.y);
    if (std::isfinite(medium.thickness) && std::abs(thickness / medium.thickness - 1) > 1e-6)
      throw Error(ErrorKind::bad_input, shape.place.file, shape.place.line, shape.place.column,
                  fmt::format("{}: plates of the multipole medium {} have different thicknesses", shape.name,
                              medium.name),
                  "one medium per thickness, or medium.thickness",
                  fmt::format("{:g} and {:g} mm", medium.thickness, thickness));
    medium.thickness = thickness;
  }
}

Document merged_document(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides, int frame) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw bad_file(file, "the scene file is empty", "a JSON object {...}");
  Document document{file, text, {overrides.begin(), overrides.end()}, {}, frame, line_starts_of(text)};
  document.root = parse_tree(document, text);
  if (document.root.kind != Node::Kind::object) return document;
  replace_deprecated_spellings(document);
  apply_overrides(document);
  return document;
}

Scene read_scene(const Document& document) {
  static const KeyInfo root{"", "scene"};
  const ObjectReader reader(Value(document, document.root, "", root), "scene");
  Scene scene;
  scene.file = document.file;
  const double mm_per_unit = scene.mm_per_unit = document.mm_per_unit;
  if (const auto media = reader.find("media"))
    for (const Value& medium : media->members()) {
      scene.media.push_back(read_medium(medium, mm_per_unit));
      for (std::string& warning : keys_without_effect(medium, scene.media.back()))
        scene.warnings.push_back(std::move(warning));
    }
  if (const auto media = reader.find("media"))
    for (std::size_t i = 0; i < scene.media.size(); ++i)
      read_layers(media->members()[i], mm_per_unit, scene.media, scene.media[i], scene.warnings);
  ShapeContext context{.mm_per_unit = mm_per_unit, .media = &scene.media};
  scene.shapes = read_named<Shape>(
      reader.find("shapes"), "shape",
      [&](const Value& value, const std::string& name) { return read_shape(value, name, context); });
  share_triangles(scene.shapes);
  take_thickness_of_plates(scene);
  scene.lights = by_channel(read_named<Light>(
      reader.find("lights"), "light",
      [&](const Value& value, const std::string& name) { return read_light(value, name, mm_per_unit); }));
  add_lights_of_shapes(context.lights, scene.lights);
  if (const auto surroundings = reader.find("surroundings")) read_surroundings(*surroundings, scene.lights);
  if (const auto backdrop = reader.find("backdrop")) scene.backdrop = backdrop->color();
  scene.camera = read_camera(reader.find("camera"), mm_per_unit);
  if (const auto film = reader.find("film")) scene.film = read_film(*film);
  if (const auto settings = reader.find("settings")) scene.settings = read_settings(*settings, mm_per_unit);
  return scene;
}

/// Sets the shortest lengths of the media, for the same samples at all wavelengths.
void share_lengths(std::span<Scene> scenes) {
  for (std::size_t m = 0; m < scenes[0].media.size(); ++m) {
    double path = std::numeric_limits<double>::infinity(), fading = path;
    for (const Scene& scene : scenes) {
      Medium medium = scene.media[m];
      medium.profile = ProfileKind::dipole;  // classical D, as in the diffusion equation
      const DiffuseProfile profile = make_diffuse_profile(medium);
      for (std::size_t c = 0; c < 3; ++c) {
        if (!(profile.total[c] > 0 && profile.mean_free_path[c] > 0)) continue;
        path = std::min(path, profile.mean_free_path[c]);
        if (profile.diffuse_mean_free_path[c] > 0)
          fading = std::min(fading, profile.diffuse_mean_free_path[c]);
      }
    }
    for (Scene& scene : scenes) {
      if (std::isfinite(path)) scene.media[m].shortest_path = path;
      if (std::isfinite(fading)) scene.media[m].shortest_fading = fading;
    }
  }
}

/// A scene with spectra is read once for each group of wavelengths.
Scene read_at_wavelengths(Document& document) {
  if (const Node* unit = find_member(document.root, "mm_per_unit"))
    document.mm_per_unit = Value(document, *unit, "mm_per_unit", key_info("scene", "mm_per_unit")).number();
  if (has_photometric_values(document)) resolve_photometric_values(document);
  const std::optional<int> count = wavelengths_of(document);
  if (!count) return read_scene(document);
  std::vector<Scene> scenes;
  for (const ThreeWavelengths& wavelengths : groups_of(spectral_rule(*count))) {
    Document resolved = document;
    resolve_spectra(resolved, wavelengths);
    resolved.wavelengths = &wavelengths;
    scenes.push_back(read_scene(resolved));
    scenes.back().wavelengths = wavelengths;
  }
  share_lengths(scenes);
  Scene first = std::move(scenes[0]);
  first.other_wavelengths.assign(std::make_move_iterator(scenes.begin() + 1),
                                 std::make_move_iterator(scenes.end()));
  return first;
}

/// Warning of a texture's colours above 1; empty: none, or a texture relative to its mean.
std::string clipped_colors(const std::optional<Texture>& texture) {
  if (!texture || texture->is_relative) return {};
  const TexelsAboveOne above = texture->source->above_one(texture->scale);
  if (above.count == 0) return {};
  if (texture->source->noise() != nullptr)
    return fmt::format("noise ({}): colours above 1 are rendered as 1; the largest is {:.3g}",
                       texture->source->path(), above.largest);
  return fmt::format("{}: {} of {} texels{} have a colour above 1, rendered as 1; the largest is {:.3g}",
                     texture->source->path(), above.count, above.texels,
                     texture->scale == Vec3d(1) ? "" : " times their scale", above.largest);
}

/// Each file once.
std::vector<std::string> texture_warnings(const Scene& scene) {
  std::set<std::string> warnings;
  for (const Shape& shape : scene.shapes) {
    warnings.insert(clipped_colors(shape.reflectance_texture));
    if (!shape.medium) continue;
    warnings.insert(clipped_colors(scene.media[*shape.medium].tint_texture));
    warnings.insert(clipped_colors(scene.media[*shape.medium].base_texture));
  }
  for (const Shape& shape : scene.shapes)
    for (const Texture* texture : textures_of(scene, shape)) warnings.insert(texture->source->warning());
  warnings.erase("");
  return {warnings.begin(), warnings.end()};
}

/// Removes line numbers of a generated text, unknown to the user.
void forget_places(Scene& scene) {
  const auto forget = [&](auto& records) {
    for (auto& record : records)
      if (record.place.file == scene.file) record.place = {};
  };
  forget(scene.media);
  forget(scene.shapes);
  forget(scene.lights);
}

/// Runs a reader of a generated text, unknown to the user: errors have no line and column.
template <class Read>
auto without_lines(const std::string& path, const Read& read) {
  try {
    return read();
  } catch (const Error& failure) {
    if (failure.file != path) throw;
    throw Error(failure.kind, path, 0, 0, failure.message, failure.expected, failure.got);
  }
}

/// Position of the scene's camera, scene units; none: missing or invalid.
std::optional<Vec3d> camera_position(const Document& document) {
  const Node* const camera = find_member(document.root, "camera");
  const Node* const position = camera != nullptr ? find_member(*camera, "position") : nullptr;
  if (position == nullptr || position->children.size() != 3) return {};
  Vec3d point;
  for (std::size_t i = 0; i < 3; ++i) {
    if (position->children[i].kind != Node::Kind::number) return {};
    point[i] = position->children[i].number;
  }
  return point;
}

bool is_fitted(const Document& document) {
  const Node* const shapes = find_member(document.root, "shapes");
  return shapes != nullptr && std::ranges::any_of(shapes->children, [](const Node& shape) {
           return find_member(shape, "fit_size") != nullptr;
         });
}

bool sets_size_or_samples(std::span<const std::string> overrides) {
  return std::ranges::any_of(overrides, [](const std::string& text) {
    const std::string key = text.substr(0, text.find('='));
    return key == "mm_per_unit" || key == "settings.samples" || key == "settings.sample_spacing" ||
           key.ends_with(".fit_size");
  });
}

/// Sphere around all shapes, in scene units.
void enclose_shapes(const Scene& scene, AssetDefaults& defaults) {
  const World world = make_world(scene);
  Bounds box;
  for (const Bounds& of_shape : world.boxes) {
    box.low = component_min(box.low, of_shape.low);
    box.high = component_max(box.high, of_shape.high);
  }
  const Vec3d middle = .5 * (box.low + box.high);
  double radius = 0;
  for (const Mesh& mesh : world.meshes)
    for (const Vec3d& p : mesh.positions) radius = std::max(radius, length(out_of_world(world, p) - middle));
  defaults.center = middle / scene.mm_per_unit;
  defaults.radius = radius / scene.mm_per_unit;
}

/// Warning of an asset's own camera or lights, placed for its size without a fit_size; empty: none.
std::string unfitted(const AssetDefaults& defaults, std::span<const std::string> overrides) {
  const auto sets = [&](const auto& is_wanted) {
    return std::ranges::any_of(
        overrides, [&](const std::string& text) { return is_wanted(text.substr(0, text.find('='))); });
  };
  if ((defaults.camera && defaults.lights) ||
      !sets([](const std::string& key) { return key.ends_with(".fit_size"); }) ||
      sets([](const std::string& key) { return key.starts_with("camera"); }))
    return {};
  return fmt::format(
      "fit_size moves and scales a mesh alone: the {} of the asset stay{}; --set mm_per_unit=... scales all "
      "of them",
      defaults.camera   ? "lights"
      : defaults.lights ? "camera"
                        : "camera and lights",
      defaults.lights ? "s" : "");
}

/// Poses while the shutter is open; empty: the camera and the shapes stay as in the scene. Steps of time are halved until
/// turning parts move almost straight in each, at most 32 steps.
std::vector<ShutterPose> shutter_poses(const Document& at_frame, const Scene& scene) {
  constexpr std::size_t kMostSteps = 32;
  if (scene.film.shutter == 0) return {};
  const auto pose_at = [&](double time) {
    Document document = merged_document(at_frame.text, at_frame.file, at_frame.overrides, at_frame.frame);
    resolve_at_shutter(document, (time - .5) * scene.film.shutter);
    Scene pose = read_at_wavelengths(document);
    return ShutterPose{std::move(pose.camera), std::move(pose.shapes)};
  };
  const auto moves = [&](const ShutterPose& pose) {
    return pose.camera != scene.camera || !std::ranges::equal(pose.shapes, scene.shapes, in_same_place);
  };
  std::vector<ShutterPose> poses{pose_at(0), {scene.camera, scene.shapes}, pose_at(1)};
  if (!moves(poses.front()) && !moves(poses.back())) return {};
  while (poses.size() <= kMostSteps) {
    const std::size_t steps = poses.size() - 1;
    bool is_straight = true;
    std::vector<ShutterPose> finer{poses[0]};
    for (std::size_t i = 0; i < steps; ++i) {
      finer.push_back(pose_at((double(i) + .5) / double(steps)));
      is_straight = is_straight && is_between(finer.back(), poses[i], poses[i + 1]);
      finer.push_back(poses[i + 1]);
    }
    if (is_straight) break;
    poses = std::move(finer);
  }
  return poses;
}

}  // namespace

Scene load_scene(const std::string& path, std::span<const std::string> overrides, int frame) {
  if (!is_asset_name(path)) return parse_scene(read_scene_text(path), path, overrides, frame);
  const ImportedAsset asset = import_asset(path, std::filesystem::path(path).filename().string());
  std::vector<std::string> all(overrides.begin(), overrides.end());
  if (!overrides.empty()) {
    const std::vector<std::string> placed =
        without_lines(path, [&] { return placed_defaults(asset, path, overrides); });
    all.insert(all.begin(), placed.begin(), placed.end());
  }
  Scene scene = without_lines(path, [&] { return parse_scene(asset.text, path, all, frame); });
  scene.translation = asset.summary;
  scene.warnings.insert(scene.warnings.begin(), asset.warnings.begin(), asset.warnings.end());
  scene.asset_bytes = asset.bytes;
  if (std::string warning = unfitted(asset.defaults, overrides); !warning.empty())
    scene.warnings.push_back(std::move(warning));
  // Each warning is also among the parts not carried.
  if (asset.not_carried.size() > asset.warnings.size()) scene.translation += "; opaline import lists all";
  forget_places(scene);
  return scene;
}

std::vector<std::string> placed_defaults(const ImportedAsset& asset, const std::string& path,
                                         std::span<const std::string> overrides) {
  AssetDefaults defaults = asset.defaults;
  std::vector<std::string> texts;
  if (defaults.opaque && !sets_size_or_samples(overrides))
    texts.push_back(fmt::format("settings.max_samples={}", kMostUnsizedSamples));
  if (!defaults.camera && !defaults.lights) return texts;
  constexpr int kFirstFrame = std::numeric_limits<int>::min();
  Document before = merged_document(asset.text, path, {}, kFirstFrame),
           now = merged_document(asset.text, path, overrides, kFirstFrame);
  if (now.root.kind != Node::Kind::object) return texts;
  resolve_keyed_values(now);
  std::optional<Vec3d> camera = camera_position(now);
  if (defaults.camera && camera == camera_position(before)) camera.reset();
  if (is_fitted(now)) enclose_shapes(parse_scene(asset.text, path, overrides), defaults);
  std::ranges::move(placement(defaults, camera), std::back_inserter(texts));
  return texts;
}

std::string read_scene_text(const std::string& path) {
  if (is_asset_name(path)) return import_asset(path, std::filesystem::path(path).filename().string()).text;
  check_is_no_other_file(path);
  std::string text = read_text(path);
  check_begins_as_scene(path, text);
  return text;
}

Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides,
                  int frame) {
  Document document = merged_document(text, file, overrides, frame);
  std::size_t camera_frames = 1;
  if (document.root.kind == Node::Kind::object) {
    camera_frames = count_camera_frames(document);
    resolve_keyed_values(document);
  }
  Scene scene = read_at_wavelengths(document);
  scene.shutter = shutter_poses(document, scene);
  scene.camera_frames = camera_frames;
  scene.warnings.insert(scene.warnings.begin(), document.warnings.begin(), document.warnings.end());
  for (std::string& warning : texture_warnings(scene)) scene.warnings.push_back(std::move(warning));
  return scene;
}

std::string merged_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides, std::optional<int> frame) {
  Document document = merged_document(text, file, overrides, frame.value_or(1));
  if (frame && document.root.kind == Node::Kind::object) resolve_keyed_values(document);
  return to_json(document.root) + '\n';
}

std::string edited_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides) {
  const Document before = merged_document(text, file, {}, 1), now = merged_document(text, file, overrides, 1);
  return edited_text(text, before.root, now.root);
}

Medium parse_medium(std::string_view text, const std::string& file) {
  Document document{file, text, {}, {}, 1, line_starts_of(text)};
  document.root = parse_tree(document, text);
  replace_deprecated_spellings(document, document.root, "");
  document.root.key = "medium";
  const Value value(document, document.root, document.root.key, key_info("scene", "media"));
  Medium medium = read_medium(value, 1);
  std::vector<std::string> none;  // its layers would be media of a scene
  read_layers(value, 1, {}, medium, none);
  return medium;
}

}  // namespace opaline
