// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_view.h"

#include <fmt/format.h>

#include <numbers>

#include "assets/gltf_ranges.h"

namespace opaline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kLongerSide = 512;  // longer side of the image, pixels

std::string label_of(const char* kind, const std::string& name, std::size_t index) {
  return name.empty() ? record_name(kind, index)
                      : std::string(kind, std::string_view(kind).size() - 1) + ' ' + in_quotes(name);
}

/// Cameras and lights look along their node's -z; a node's scale is ignored.
Vec3d forward(const Transform& to_world) {
  return -normalized(to_world.z);
}

Json picture_size(double aspect_ratio) {
  const auto shorter = [](double share) { return std::max(1, int(std::lround(kLongerSide * share))); };
  if (!(aspect_ratio > 0)) return {kLongerSide, kLongerSide};
  return aspect_ratio >= 1 ? Json{kLongerSide, shorter(1 / aspect_ratio)}
                           : Json{shorter(aspect_ratio), kLongerSide};
}

/// glTF measures point and spot lights in candela, directional ones in lux, and lengths in metres. A lux
/// becomes 1 W/mm^2; a candela then is 1e6 W/sr, as there are 1e6 mm^2 in a square metre.
constexpr double kIntensityOfCandela = 1e6;

double luminance(const Vec3d& color) {
  return .2126 * color.x + .7152 * color.y + .0722 * color.z;
}

class LightTranslator {
 public:
  LightTranslator(const GltfModel& gltf, std::size_t index, const Transform& to_world, AssetScene& scene)
      : path_(gltf.path),
        json_(light_within_ranges(gltf, index, scene)),
        light_(path_, record_name("lights", index), json_),
        type_(light_.text("type")),
        intensity_(light_.number("intensity", 1)),
        to_world_(to_world),
        scene_(scene) {}

  void run(const std::string& name, const std::string& label) {
    const Vec3d brightness = color() * intensity_;
    if (!(luminance(brightness) <= 1e20))
      light_.fail("intensity", "is too large", "at most 1e20", fmt::format("{}", intensity_));
    const bool has_place = type_ == "point" || type_ == "spot";
    if (!has_place && type_ != "directional")
      light_.fail("type", "is unknown", "point, spot or directional", in_quotes(type_));
    Json json{{"type", type_}, {"name", name}};
    if (has_place) json["position"] = triple_json(to_world_.translation);
    if (type_ != "point") json["direction"] = triple_json(forward(to_world_));
    json[has_place ? "intensity" : "irradiance"] =
        triple_json(brightness * (has_place ? kIntensityOfCandela : 1));
    if (type_ == "spot") add_cone(json, label);
    scene_.lights.push_back(std::move(json));
    scene_.center_irradiance += at_center(brightness, has_place);
    scene_.translated.push_back(fmt::format(
        "{}: {} of {} {} -> {} {} W/{}", label, type_, short_triple(brightness), has_place ? "cd" : "lx",
        has_place ? "intensity" : "irradiance",
        short_triple(brightness * (has_place ? kIntensityOfCandela : 1)), has_place ? "sr" : "mm^2"));
    if (const double range = light_.number("range", 0); range > 0)
      scene_.not_carried.push_back(label + fmt::format(": range {:.4g} m", range));
  }

 private:
  Vec3d color() const {
    const std::vector<double> c = light_.numbers("color", 3);
    return c.empty() ? Vec3d(1) : Vec3d(c[0], c[1], c[2]);
  }

  void add_cone(Json& json, const std::string& label) {
    const GltfRecord spot = light_.record("spot");
    double outer = spot.number("outerConeAngle", std::numbers::pi / 4) * kDegrees,
           inner = spot.number("innerConeAngle", 0) * kDegrees;
    // A hard edge, invalid in glTF but written by Blender's exporter, becomes the narrowest valid falloff.
    constexpr double kHardRim = .999, kRounding = 1e-6;
    if (inner > kHardRim * outer && inner <= (1 + kRounding) * outer) inner = kHardRim * outer;
    if (!(outer > 0 && outer <= 90 && inner >= 0 && inner < outer)) {
      scene_.warn(path_, label + fmt::format(": cone angles of {:.4g} and {:.4g} degrees; uses 0 and 45",
                                             inner, outer));
      outer = 45, inner = 0;
    }
    json["outer_angle"] = outer;
    json["inner_angle"] = inner;
  }

  /// A light inside the asset shines on the center as from its surface.
  double at_center(const Vec3d& brightness, bool has_place) const {
    if (!has_place) return luminance(brightness);
    const double distance = std::max(length(to_world_.translation - scene_.center), scene_.radius);
    return luminance(brightness) / (distance * distance);
  }

  const std::string& path_;
  Json json_;
  GltfRecord light_;
  std::string type_;
  double intensity_;
  const Transform& to_world_;
  AssetScene& scene_;
};

}  // namespace

void add_camera(const GltfModel& gltf, std::size_t node, const Transform& to_world, AssetScene& scene) {
  const std::uint32_t index = gltf.nodes[node].camera;
  if (index == kNoRecord) return;
  const GltfRecord camera = gltf.record("cameras", index), perspective = camera.record("perspective"),
                   orthographic = camera.record("orthographic");
  const bool is_parallel = camera.text("type") == "orthographic";
  const std::string own_name = camera.text("name");
  const std::string label = label_of("cameras", own_name.empty() ? gltf.nodes[node].name : own_name, index);
  const double view = perspective.number("yfov", 0) * kDegrees,
               height = 2 * std::abs(orthographic.number("ymag", 0));
  const Vec3d up = normalized(to_world.y);
  if (!scene.camera.is_null())
    scene.not_carried.push_back(label + ": ignored, the scene already has one");
  else if (!(is_parallel ? std::isfinite(height) && height > 0 : view > 0 && view < 180) ||
           length(cross(forward(to_world), up)) < 1e-6)
    scene.not_carried.push_back(label + fmt::format(": ignored, its {} or its node is invalid",
                                                    is_parallel
                                                        ? fmt::format("height of {:.4g} m", height)
                                                        : fmt::format("angle of {:.4g} degrees", view)));
  else {
    const double distance = std::max(length(scene.center - to_world.translation), scene.radius);
    scene.camera = {{"position", triple_json(to_world.translation)},
                    {"look_at", triple_json(to_world.translation + forward(to_world) * distance)},
                    {"up", triple_json(up)}};
    if (is_parallel) {
      scene.camera["orthographic_height"] = height;
      scene.film["resolution"] = picture_size(2 * std::abs(orthographic.number("xmag", 0)) / height);
      scene.translated.push_back(fmt::format("{} -> camera, orthographic, {:.4g} m high", label, height));
      return;
    }
    scene.camera["field_of_view"] = view;
    scene.film["resolution"] = picture_size(perspective.number("aspectRatio", 0));
    scene.translated.push_back(
        fmt::format("{} -> camera, field of view {:.4g} degrees (vertical)", label, view));
  }
}

void add_light(const GltfModel& gltf, std::size_t node, const Transform& to_world, UniqueNames& names,
               AssetScene& scene) {
  const std::uint32_t index = gltf.nodes[node].light;
  if (index == kNoRecord) return;
  const std::string own_name = gltf.record("lights", index).text("name");
  const std::string name = names.take(own_name.empty() ? gltf.nodes[node].name : own_name, "light");
  LightTranslator(gltf, index, to_world, scene).run(name, "light " + in_quotes(name));
}

}  // namespace opaline
