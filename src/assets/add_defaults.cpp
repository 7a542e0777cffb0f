// SPDX-License-Identifier: GPL-3.0-or-later
// Default camera and lights for a scene without.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "assets/asset_scene.h"

namespace opaline {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

// A three-quarter view: glTF assets face +z.
constexpr double kAzimuth = 35, kElevation = 20, kFieldOfView = 30;  // degrees
constexpr double kMargin = 1.05;  // radius of the visible sphere, over the asset's
constexpr int kSamplesPerPixel = 4;

/// An invisible sphere light: position, in units along the image's right, the world's up and towards the
/// camera; radius over that of the asset; and radiance of a white diffuse surface at the asset's centre
/// facing it.
struct DefaultLight {
  const char* name;
  Vec3d direction;
  double radius, white;
};

// White stays below 1 even at the asset's points nearest to a light, up to 1.8 times as bright.
constexpr std::array<DefaultLight, 3> kLights{
    {{"key", {-.7, .7, .7}, .8, .52}, {"fill", {.9, .2, .8}, 1.2, .16}, {"rim", {.3, 1, -.8}, .6, .35}}};
constexpr double kLightDistance = 4;  // over the asset's radius
constexpr double kBackdrop = .1;      // between a diffuse surface's light and shadow
constexpr double kWhite = .8;         // exposure of a white surface under the asset's own lights

// Darkening of the PNG, stops, above which highlights may exceed the largest half, 65504.
constexpr double kHalfExposure = -8;

Vec3d default_view() {
  const double azimuth = kAzimuth * kRadians, elevation = kElevation * kRadians;
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

void add_camera(AssetScene& scene) {
  const double distance = kMargin * scene.radius / std::sin(kFieldOfView * kRadians / 2);
  scene.camera = {{"position", triple_json(scene.center + default_view() * distance)},
                  {"look_at", triple_json(scene.center)},
                  {"field_of_view", kFieldOfView}};
  scene.translated.push_back("no camera: a default one frames the asset");
}

Vec3d vector_of(const Json& triple) {
  return {triple[0].get<double>(), triple[1].get<double>(), triple[2].get<double>()};
}

/// Frame for placing lights.
struct ViewFrame {
  Vec3d right, up, towards_camera;
};

/// View from the scene's camera to the asset's centre. The default view if the camera is at the centre or
/// looks along up.
ViewFrame view_frame(const AssetScene& scene) {
  const Vec3d up{0, 1, 0};
  const Json& position = scene.camera["position"];
  Vec3d towards = vector_of(position.is_object() ? *position["keyed"].begin() : position) - scene.center;
  constexpr double kNear = .01;  // fraction of the asset's radius, or of a right angle
  if (!(length(cross(up, towards)) > kNear * std::max(length(towards), scene.radius)))
    towards = default_view();
  return {normalized(cross(up, towards)), up, normalized(towards)};
}

void add_lights(AssetScene& scene) {
  if (!scene.lights.empty()) scene.not_carried.push_back("its lights: ignored, they emit nothing");
  scene.lights = Json::array();
  const auto [right, up, forward] = view_frame(scene);
  for (const DefaultLight& light : kLights) {
    const Vec3d& d = light.direction;
    const Vec3d direction = normalized(right * d.x + up * d.y + forward * d.z);
    const double ratio = kLightDistance / light.radius;
    scene.lights.push_back(
        {{"type", "sphere"},
         {"name", light.name},
         {"center", triple_json(scene.center + direction * (kLightDistance * scene.radius))},
         {"radius", light.radius * scene.radius},
         {"radiance", light.white * ratio * ratio},
         {"visible", false}});
  }
  scene.backdrop = kBackdrop;
  scene.translated.push_back(
      "no lights: adds default lights key, fill and rim around the asset, and a grey backdrop");
}

/// Exposure mapping a white surface, facing all lights at the asset's centre, to kWhite in the PNG.
void add_exposure(AssetScene& scene) {
  const double stops = std::log2(kWhite * std::numbers::pi / scene.center_irradiance);
  const double exposure = std::clamp(std::round(stops * 100) / 100, -100., 100.);
  scene.film["exposure"] = exposure;
  if (exposure < kHalfExposure) scene.film["pixel_type"] = "float";
  scene.translated.push_back(
      fmt::format("exposure {:.2f} stops: a white surface at the centre of the asset has the value {}",
                  exposure, kWhite));
}

}  // namespace

void add_defaults(AssetScene& scene) {
  if (!scene.film.contains("resolution")) scene.film["resolution"] = {512, 512};
  scene.film["samples_per_pixel"] = kSamplesPerPixel;
  if (scene.camera.is_null()) add_camera(scene);
  if (scene.center_irradiance > 0)
    add_exposure(scene);
  else
    add_lights(scene);
}

std::vector<std::string> placement(const AssetDefaults& defaults, const std::optional<Vec3d>& camera) {
  AssetScene scene;
  scene.center = defaults.center;
  scene.radius = defaults.radius;
  add_camera(scene);
  std::vector<std::string> texts;
  if (defaults.camera)
    for (const char* key : {"position", "look_at"})
      texts.push_back("camera." + std::string(key) + '=' + scene.camera[key].dump());
  if (camera) scene.camera["position"] = triple_json(*camera);
  if (!defaults.lights) return texts;
  add_lights(scene);
  for (const Json& light : scene.lights)
    for (const char* key : {"center", "radius"})
      texts.push_back("lights." + light["name"].get<std::string>() + '.' + key + '=' + light[key].dump());
  return texts;
}

}  // namespace opaline
