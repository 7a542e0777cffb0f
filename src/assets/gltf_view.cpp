// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_view.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

namespace opaline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kLongerSide = 512;  // of the picture, pixels

std::string label_of(const char* kind, const std::string& name, std::size_t index) {
  return name.empty() ? record_name(kind, index)
                      : std::string(kind, std::string_view(kind).size() - 1) + ' ' + in_quotes(name);
}

/// Cameras and lights look along their node's -z; a node's scale does not count.
Vec3d forward(const Transform& to_world) {
  return -normalized(to_world.z);
}

Json picture_size(double aspect_ratio) {
  const auto shorter = [](double share) { return std::max(1, int(std::lround(kLongerSide * share))); };
  if (!(aspect_ratio > 0)) return {kLongerSide, kLongerSide};
  return aspect_ratio >= 1 ? Json{kLongerSide, shorter(1 / aspect_ratio)}
                           : Json{shorter(aspect_ratio), kLongerSide};
}

/// glTF counts point and spot lights in candela, directional ones in lux, and lengths in metres.
/// A lux is drawn as 1 W/mm^2: a candela then is 1e6 W/sr, as there are 1e6 mm^2 in a square metre.
constexpr double kIntensityOfCandela = 1e6;

double luminance(const Vec3d& color) {
  return .2126 * color.x + .7152 * color.y + .0722 * color.z;
}

class LightTranslator {
 public:
  LightTranslator(const GltfModel& gltf, std::size_t index, const Transform& to_world, AssetScene& scene)
      : gltf_(gltf),
        light_(gltf.model.lights[index]),
        place_(record_name("extensions.KHR_lights_punctual.lights", index)),
        to_world_(to_world),
        scene_(scene) {}

  void run(const std::string& name, const std::string& label) {
    const Vec3d brightness = color() * light_.intensity;
    if (!(light_.intensity >= 0 && luminance(brightness) <= 1e20))
      fail_at(gltf_.path, place_, "is no brightness", "a color and an intensity from 0",
              fmt::format("{}", light_.intensity));
    const bool has_place = light_.type == "point" || light_.type == "spot";
    if (!has_place && light_.type != "directional")
      fail_at(gltf_.path, place_ + ".type", "is unknown", "point, spot or directional",
              in_quotes(light_.type));
    Json json{{"type", light_.type}, {"name", name}};
    if (has_place) json["position"] = triple_json(to_world_.translation);
    if (light_.type != "point") json["direction"] = triple_json(forward(to_world_));
    json[has_place ? "intensity" : "irradiance"] =
        triple_json(brightness * (has_place ? kIntensityOfCandela : 1));
    if (light_.type == "spot") add_cone(json, label);
    scene_.lights.push_back(std::move(json));
    scene_.center_irradiance += at_center(brightness, has_place);
    scene_.translated.push_back(fmt::format(
        "{}: {} of {} {} -> {} {} W/{}", label, light_.type, short_triple(brightness),
        has_place ? "cd" : "lx", has_place ? "intensity" : "irradiance",
        short_triple(brightness * (has_place ? kIntensityOfCandela : 1)), has_place ? "sr" : "mm^2"));
    if (light_.range > 0) scene_.not_carried.push_back(label + fmt::format(": range {:.4g} m", light_.range));
  }

 private:
  Vec3d color() const {
    const std::vector<double>& c = light_.color;
    if (c.empty()) return Vec3d(1);
    if (c.size() != 3 || std::ranges::any_of(c, [](double v) { return !(v >= 0); }))
      fail_at(gltf_.path, place_ + ".color", "is no colour", "three numbers from 0");
    return {c[0], c[1], c[2]};
  }

  void add_cone(Json& json, const std::string& label) {
    double outer = light_.spot.outerConeAngle * kDegrees, inner = light_.spot.innerConeAngle * kDegrees;
    // A hard rim, which glTF does not allow and Blender's exporter writes as it is: the narrowest that fades.
    constexpr double kHardRim = .999, kRounding = 1e-6;
    if (inner > kHardRim * outer && inner <= (1 + kRounding) * outer) inner = kHardRim * outer;
    if (!(outer > 0 && outer <= 90 && inner >= 0 && inner < outer)) {
      scene_.not_carried.push_back(
          label +
          fmt::format(": cone angles of {:.4g} and {:.4g} degrees; 0 and 45 are taken", inner, outer));
      outer = 45, inner = 0;
    }
    json["outer_angle"] = outer;
    json["inner_angle"] = inner;
  }

  /// Of a light within the asset as from its surface.
  double at_center(const Vec3d& brightness, bool has_place) const {
    if (!has_place) return luminance(brightness);
    const double distance = std::max(length(to_world_.translation - scene_.center), scene_.radius);
    return luminance(brightness) / (distance * distance);
  }

  const GltfModel& gltf_;
  const tinygltf::Light& light_;
  std::string place_;
  const Transform& to_world_;
  AssetScene& scene_;
};

}  // namespace

void add_camera(const GltfModel& gltf, std::size_t node, const Transform& to_world, AssetScene& scene) {
  const int index = gltf.model.nodes[node].camera;
  if (index < 0) return;
  const tinygltf::Camera& camera = gltf.model.cameras[std::size_t(index)];
  const std::string label = label_of(
      "cameras", camera.name.empty() ? gltf.model.nodes[node].name : camera.name, std::size_t(index));
  const double view = camera.perspective.yfov * kDegrees;
  const Vec3d up = normalized(to_world.y);
  if (!scene.camera.is_null())
    scene.not_carried.push_back(label + ": the scene has one already");
  else if (camera.type != "perspective")
    scene.not_carried.push_back(label + ": it is orthographic");
  else if (!(view > 0 && view < 180) || length(cross(forward(to_world), up)) < 1e-6)
    scene.not_carried.push_back(label +
                                fmt::format(": its angle of {:.4g} degrees or its node is of no use", view));
  else {
    const double distance = std::max(length(scene.center - to_world.translation), scene.radius);
    scene.camera = {{"position", triple_json(to_world.translation)},
                    {"look_at", triple_json(to_world.translation + forward(to_world) * distance)},
                    {"up", triple_json(up)},
                    {"field_of_view", view}};
    scene.film["resolution"] = picture_size(camera.perspective.aspectRatio);
    scene.translated.push_back(fmt::format("{} -> camera, {:.4g} degrees high", label, view));
  }
}

void add_light(const GltfModel& gltf, std::size_t node, const Transform& to_world, UniqueNames& names,
               AssetScene& scene) {
  const auto& extensions = gltf.model.nodes[node].extensions;
  const auto found = extensions.find("KHR_lights_punctual");
  if (found == extensions.end()) return;
  const tinygltf::Value& light = found->second.Has("light") ? found->second.Get("light") : found->second;
  const std::string place = record_name("nodes", node) + ".extensions.KHR_lights_punctual.light";
  const std::size_t count = gltf.model.lights.size();
  if (!light.IsInt() || light.GetNumberAsInt() < 0 || std::size_t(light.GetNumberAsInt()) >= count)
    fail_at(gltf.path, place, "points at nothing", "one of " + std::to_string(count) + " lights",
            light.IsInt() ? std::to_string(light.GetNumberAsInt()) : "no index");
  const auto index = std::size_t(light.GetNumberAsInt());
  const std::string& own_name = gltf.model.lights[index].name;
  const std::string wanted = own_name.empty() ? gltf.model.nodes[node].name : own_name;
  const std::string name = names.take(wanted, "light");
  LightTranslator(gltf, index, to_world, scene).run(name, "light " + in_quotes(name));
}

}  // namespace opaline
