// SPDX-License-Identifier: GPL-3.0-or-later
// Every key of a scene file, changed in a session: what the session keeps must not outlive what it was computed from.
#include <map>

#include "../assets/asset_test.h"
#include "../core/scratch_folder.h"
#include "input/load_scene.h"
#include "input/schema.h"
#include "opaline/image.h"
#include "session_test.h"

namespace opaline::test {
namespace {

using Overrides = std::vector<std::string>;

/// A change of one key, told by "section.key", and the scene in which it matters.
struct Change {
  std::string key, override;
  Overrides before = {};  ///< of the scene
};

const std::string kScene = R"({
  "media": {"stone": {"sigma_a": [0.02, 0.04, 0.07], "sigma_s_prime": [1.2, 1.6, 2]},
            "wax": {"subsurface_color": [0.8, 0.7, 0.5], "subsurface_radius": [2, 1, 0.7]}},
  "shapes": [{"name": "ball", "sphere": {"center": [-12, 9, 0], "radius": 9}, "medium": "stone"},
             {"name": "ring", "torus": {"center": [14, 6, 0], "major_radius": 8, "minor_radius": 3}, "medium": "wax"},
             {"name": "floor", "quad": {"corner": [-60, -1, 60], "u": [120, 0, 0], "v": [0, 0, -120]},
              "reflectance": {"texture": "cells.png"}}],
  "lights": [{"name": "key", "type": "point", "position": [0, 100, 20], "intensity": 3e4},
             {"name": "panel", "type": "quad", "corner": [-20, 90, 30], "u": [40, 0, 0], "v": [0, 0, 20], "radiance": 5}],
  "camera": {"position": [0, 30, 120], "look_at": [0, 8, 0], "field_of_view": 32},
  "film": {"resolution": [18, 12], "pixel_type": "float"},
  "settings": {"method": "hierarchical", "samples": 150, "light_samples": 2}
})";

const std::string kSphereLight = R"({"type": "sphere", "center": [0, 90, 20], "radius": 9, "radiance": 20})";
const std::string kSpot =
    R"({"type": "spot", "position": [0, 90, 20], "direction": [0, -9, -2], "intensity": 3e4, "outer_angle": 12})";
const std::string kSun = R"({"type": "directional", "direction": [0, -2, -1], "irradiance": 2})";
const std::string kRoom = R"({"type": "environment", "file": "room.exr"})";
const std::string kBox =
    R"({"name": "ball", "box": {"low": [-20, 0, -8], "high": [-4, 16, 8]}, "medium": "stone"})";
const std::string kSlab =
    R"({"name": "ball", "slab": {"center": [-12, 9, 0], "width": 18, "depth": 16, "thickness": 4}, "medium": "stone"})";
const std::string kRough = "media.stone.specular_roughness=0.5";
const std::string kGloss = "shapes.floor.specular_roughness=0.4";
const std::string kMap = R"(shapes.ball.normal_map={"texture": "cells.png"})";
const std::array<std::string, 2> kLayers{
    R"(media.flesh={"preset": "skin1"})",
    R"(media.stone={"layers": [{"medium": "flesh", "thickness": 1}, {"medium": "wax"}]})"};
const std::string kMesh = R"(shapes.ball={"name": "ball", "file": "bump.obj", "medium": "stone"})";
const std::string kWalk =
    R"(shapes.ball={"name": "ball", "file": "walk.glb", "part": "0/0/0", "animation_time": 1, "medium": "stone"})";
const std::string kColoredMesh = R"(shapes.ball={"name": "ball", "file": "coloured.obj", "medium": "stone"})";

std::vector<Change> changes() {
  const auto light = [](const std::string& json) { return Overrides{"lights.panel=" + json}; };
  const auto shape = [](const std::string& json) { return Overrides{"shapes.ball=" + json}; };
  const auto step = [](const std::string& json) { return "shapes.ball.transform=[" + json + "]"; };
  const auto texture = [](const std::string& rest) {
    return R"(shapes.floor.reflectance={"texture": "cells.png", )" + rest + "}";
  };
  const auto noise = [](const std::string& pattern, const std::string& rest) {
    return R"(shapes.floor.reflectance={"noise": ")" + pattern + "\", " + rest + "}";
  };
  const Overrides clouds{noise("clouds", R"("size": 4)")};
  const Overrides tissue{R"(media.stone.sigma_a={"tissue": {"melanin": 0.01, "blood": 0.01}})"};
  const Overrides spectrum{R"(media.stone.sigma_a={"nm": [400, 700], "values": [0.1, 0.01]})"};
  const Overrides volume{"settings.method=volume", "settings.bounces=0", "settings.samples=30"},
      cells{"settings.method=volume_diffusion", "settings.bounces=0", "settings.max_samples=300"};
  return {
      {"scene.mm_per_unit", "mm_per_unit=2"},
      {"scene.media", R"(media={"stone": {"preset": "skin1"}, "wax": {"preset": "cream"}})"},
      {"scene.shapes", R"(shapes=[{"sphere": {"radius": 9}, "medium": "wax"}])"},
      {"scene.lights", R"(lights=[{"type": "point", "position": [9, 90, 9], "intensity": 3e4}])"},
      {"scene.surroundings", "surroundings=0.5"},
      {"scene.backdrop", "backdrop=0.3", {"backdrop=0.2"}},
      {"scene.camera", R"(camera={"position": [0, 20, 150]})"},
      {"scene.film", R"(film={"resolution": [15, 12]})"},
      {"scene.settings", R"(settings={"samples": 300, "method": "hierarchical"})"},
      {"medium.preset", R"(media.stone={"preset": "skin1"})"},
      {"medium.sigma_a", "media.stone.sigma_a=0.01"},
      {"medium.sigma_s_prime", "media.stone.sigma_s_prime=3"},
      {"medium.sigma_s", R"(media.stone={"sigma_a": 0.02, "sigma_s": 3})"},
      {"medium.g",
       R"(media.stone={"sigma_a": 0.02, "sigma_s": 3, "g": 0.5})",
       {R"(media.stone={"sigma_a": 0.02, "sigma_s": 3})"}},
      {"medium.subsurface_color", "media.wax.subsurface_color=0.5"},
      {"medium.subsurface_radius", "media.wax.subsurface_radius=2.5"},
      {"medium.subsurface_radius",
       R"(media.wax.subsurface_radius={"texture": "other.png", "scale": 12})",
       {cells[0], cells[1], cells[2],
        R"(media.wax.subsurface_radius={"texture": "cells.png", "scale": 12})"}},
      {"medium.subsurface_radius",
       R"(media.wax.subsurface_radius={"texture": "other.png", "scale": 12})",
       {volume[0], volume[1], volume[2],
        R"(media.wax.subsurface_radius={"texture": "cells.png", "scale": 12})"}},
      {"medium.subsurface_color",
       R"(media.wax.subsurface_color={"texture": "other.png"})",
       {cells[0], cells[1], cells[2], "media.wax.texture_mix=medium",
        R"(media.wax.subsurface_color={"texture": "cells.png"})"}},
      {"medium.subsurface_radius_scale", "media.wax.subsurface_radius_scale=0.5"},
      {"medium.subsurface_scatter_anisotropy", "media.wax.subsurface_scatter_anisotropy=0.4"},
      {"medium.scatter_anisotropy", "media.stone.scatter_anisotropy=0.6", volume},
      {"medium.specular_ior", "media.stone.specular_ior=1.6"},
      {"medium.specular_roughness", "media.stone.specular_roughness=0.5"},
      {"medium.specular_weight", "media.stone.specular_weight=0.5"},
      {"medium.specular_anisotropy", "media.stone.specular_anisotropy=0.8", {kRough}},
      {"medium.specular_rotation",
       "media.stone.specular_rotation=40",
       {kRough, "media.stone.specular_anisotropy=0.8"}},
      {"medium.fuzz_weight", "media.stone.fuzz_weight=0.6"},
      {"medium.fuzz_color", "media.stone.fuzz_color=[0.2, 0.4, 0.9]", {"media.stone.fuzz_weight=0.6"}},
      {"medium.fuzz_roughness", "media.stone.fuzz_roughness=1", {"media.stone.fuzz_weight=0.6"}},
      {"medium.fuzz_weight",
       R"(media.stone.fuzz_weight={"texture": "other.png"})",
       {R"(media.stone.fuzz_weight={"texture": "cells.png"})"}},
      {"medium.fuzz_weight",
       R"(media.wax.fuzz_weight={"texture": "other.png"})",
       {cells[0], cells[1], cells[2], R"(media.wax.fuzz_weight={"texture": "cells.png"})"}},
      {"medium.fuzz_weight",
       R"(media.wax.fuzz_weight={"texture": "other.png"})",
       {volume[0], volume[1], volume[2], R"(media.wax.fuzz_weight={"texture": "cells.png"})"}},
      {"medium.fuzz_roughness",
       R"(media.stone.fuzz_roughness={"texture": "other.png"})",
       {"media.stone.fuzz_weight=0.6", R"(media.stone.fuzz_roughness={"texture": "cells.png"})"}},
      {"medium.fuzz_color",
       R"(media.stone.fuzz_color={"texture": "other.png"})",
       {"media.stone.fuzz_weight=0.6", R"(media.stone.fuzz_color={"texture": "cells.png"})"}},
      {"medium.tint", "media.stone.tint=[0.5, 0.7, 0.9]"},
      {"medium.subsurface_weight", "media.stone.subsurface_weight=0.5"},
      {"medium.base_color", "media.stone.base_color=[0.1, 0.2, 0.3]", {"media.stone.subsurface_weight=0.5"}},
      {"medium.texture_mix", "media.stone.texture_mix=pre", {R"(media.stone.tint={"texture": "cells.png"})"}},
      {"medium.texture_mix",
       "media.wax.texture_mix=medium",
       {cells[0], cells[1], cells[2], R"(media.wax.subsurface_color={"texture": "cells.png"})"}},
      {"settings.method",
       "settings.method=volume_diffusion",
       {"media.wax.texture_mix=medium", "settings.max_samples=300",
        R"(media.wax.subsurface_color={"texture": "cells.png"})"}},
      {"medium.layers", kLayers[1], {kLayers[0], "media.stone.profile=dipole"}},
      {"medium.layers", kLayers[1], {cells[0], cells[1], cells[2], kLayers[0]}},
      {"medium.layers.medium",
       "media.stone.layers.0.medium=wax",
       {kLayers[0], kLayers[1], "media.stone.profile=dipole"}},
      {"medium.layers.medium",
       "media.stone.layers.0.medium=wax",
       {cells[0], cells[1], cells[2], kLayers[0], kLayers[1]}},
      {"medium.layers.thickness",
       "media.stone.layers.0.thickness=2",
       {kLayers[0], kLayers[1], "media.stone.profile=dipole"}},
      {"medium.layers.thickness",
       "media.stone.layers.0.thickness=1.1",
       {kLayers[0], kLayers[1], "media.stone.profile=tabulated"}},
      {"medium.layers.thickness",
       R"(media.stone.layers.0.thickness={"texture": "other.png"})",
       {cells[0], cells[1], cells[2], kLayers[0], kLayers[1],
        R"(media.stone.layers.0.thickness={"texture": "cells.png"})"}},
      {"medium.layers.thickness",
       R"(media.stone.layers.0.thickness={"texture": "other.png"})",
       {volume[0], volume[1], volume[2], "shapes.ball.sphere.radius=6", kLayers[0], kLayers[1],
        R"(media.stone.layers.0.thickness={"texture": "cells.png"})"}},
      {"medium.thickness", "media.stone.thickness=3", {"media.stone.profile=multipole"}},
      {"medium.profile", "media.stone.profile=dipole"},
      {"medium.fit", "media.stone.fit=searchlight", {"media.stone.profile=normalized_diffusion"}},
      {"shape.file", R"(shapes.ball={"name": "ball", "file": "bump.obj", "medium": "stone"})"},
      {"shape.part", "shapes.ball.part=lid", {kMesh}},
      {"shape.sphere", "shapes.ball.sphere={\"radius\": 8}"},
      {"shape.box", "shapes.ball=" + kBox},
      {"shape.quad", R"(shapes.floor.quad={"corner": [-50, -2, 50], "u": [100, 0, 0], "v": [0, 0, -100]})"},
      {"shape.slab", "shapes.ball=" + kSlab},
      {"shape.torus", R"(shapes.ring.torus={"major_radius": 8, "minor_radius": 2})"},
      {"shape.fill_holes", "shapes.ball.fill_holes=true", {kMesh, "shapes.ball.part=body"}},
      {"shape.fit_size", "shapes.ball.fit_size=24", {kMesh}},
      {"shape.emission", "shapes.ring.emission=[0.5, 1, 2]"},
      {"shape.emission",
       R"(shapes.ball.emission={"texture": "other.png"})",
       {R"(shapes.ball.emission={"texture": "cells.png"})"}},
      {"shape.vertex_colors", "shapes.ball.vertex_colors=false", {kColoredMesh}},
      {"shape.crease_angle", "shapes.ball.crease_angle=20", {kMesh}},
      {"shape.subdivide", "shapes.ball.subdivide=1", {kMesh}},
      {"shape.animation_time", "shapes.ball.animation_time=0.5", {kWalk}},
      {"shape.animation", "shapes.ball.animation=run", {kWalk}},
      {"shape.transform", step(R"({"translate": [0, 3, 0]})")},
      {"shape.normals", "shapes.ball.normals=faceted"},
      {"shape.visible", "shapes.ring.visible=false"},
      {"shape.shadow_catcher", "shapes.floor.shadow_catcher=true"},
      {"shape.medium", "shapes.ball.medium=wax"},
      {"shape.reflectance", "shapes.floor.reflectance=0.9"},
      {"shape.metalness", "shapes.floor.metalness=0.5", {kGloss}},
      {"shape.specular_roughness", "shapes.floor.specular_roughness=0.2", {kGloss}},
      {"shape.specular_ior", "shapes.floor.specular_ior=2", {kGloss}},
      {"shape.specular_weight", "shapes.floor.specular_weight=0.3", {kGloss}},
      {"shape.specular_anisotropy", "shapes.floor.specular_anisotropy=0.8", {kGloss}},
      {"shape.specular_rotation",
       "shapes.floor.specular_rotation=40",
       {kGloss, "shapes.floor.specular_anisotropy=0.8"}},
      {"shape.fuzz_weight", "shapes.floor.fuzz_weight=0.6"},
      {"shape.fuzz_color", "shapes.floor.fuzz_color=[0.2, 0.4, 0.9]", {"shapes.floor.fuzz_weight=0.6"}},
      {"shape.fuzz_weight",
       R"(shapes.floor.fuzz_weight={"texture": "other.png"})",
       {R"(shapes.floor.fuzz_weight={"texture": "cells.png"})"}},
      {"shape.fuzz_roughness", "shapes.floor.fuzz_roughness=1", {"shapes.floor.fuzz_weight=0.6"}},
      {"shape.normal_map", kMap},
      {"shape.bump_map", R"(shapes.ball.bump_map={"texture": "cells.png", "scale": 2})"},
      {"shape.displacement", R"(shapes.ball.displacement={"noise": "clouds", "size": 4, "scale": 2})"},
      {"shape.displacement",
       R"(shapes.ball.displacement={"texture": "other.png"})",
       {R"(shapes.ball.displacement={"texture": "cells.png"})"}},
      {"shape.opacity", R"(shapes.floor.opacity={"texture": "cells.png"})"},
      {"shape.opacity",
       R"(shapes.floor.opacity={"texture": "cells.png", "scale": 1000})",
       {R"(shapes.floor.opacity={"texture": "cells.png", "scale": 0})"}},
      {"shape.group", "shapes.ring.group=pair", {"shapes.ball.group=pair", "shapes.ring.medium=stone"}},
      {"texture.texture", R"(shapes.floor.reflectance.texture=other.png)"},
      {"texture.color_space", texture(R"("color_space": "linear")")},
      {"texture.scale", texture(R"("scale": 0.5)")},
      {"texture.channel",
       R"(shapes.floor.specular_roughness={"texture": "cells.png", "channel": "g"})",
       {R"(shapes.floor.specular_roughness={"texture": "cells.png"})"}},
      {"texture.uv_scale", texture(R"("uv_scale": [2, 3])")},
      {"texture.uv_rotation", texture(R"("uv_rotation": 30)")},
      {"texture.uv_offset", texture(R"("uv_offset": [0.2, 0.1])")},
      {"shape.sphere.center", "shapes.ball.sphere.center=[-12, 10, 2]"},
      {"shape.sphere.radius", "shapes.ball.sphere.radius=8"},
      {"shape.box.low", "shapes.ball.box.low=[-20, 2, -8]", shape(kBox)},
      {"shape.box.high", "shapes.ball.box.high=[-4, 14, 8]", shape(kBox)},
      {"shape.quad.corner", "shapes.floor.quad.corner=[-60, -3, 60]"},
      {"shape.quad.u", "shapes.floor.quad.u=[90, 0, 0]"},
      {"shape.quad.v", "shapes.floor.quad.v=[0, 0, -70]"},
      {"shape.slab.center", "shapes.ball.slab.center=[-12, 12, 0]", shape(kSlab)},
      {"shape.slab.width", "shapes.ball.slab.width=12", shape(kSlab)},
      {"shape.slab.depth", "shapes.ball.slab.depth=12", shape(kSlab)},
      {"shape.slab.thickness", "shapes.ball.slab.thickness=6", shape(kSlab)},
      {"shape.torus.center", "shapes.ring.torus.center=[14, 9, 0]"},
      {"shape.torus.major_radius", "shapes.ring.torus.major_radius=9"},
      {"shape.torus.minor_radius", "shapes.ring.torus.minor_radius=2"},
      {"shape.transform.translate",
       step(R"({"translate": [0, 4, 0]})"),
       {step(R"({"translate": [0, 2, 0]})")}},
      {"shape.transform.scale", step(R"({"scale": 0.8})"), {step(R"({"scale": 0.9})")}},
      {"shape.transform.rotate", step(R"({"rotate": {"axis": [0, 0, 1], "degrees": 20}})")},
      {"shape.transform.matrix", step(R"({"matrix": [[1,0,0,0],[0,1,0.3,0],[0,0,1,0]]})")},
      {"shape.transform.rotate.axis",
       step(R"({"rotate": {"axis": [1, 0, 1], "degrees": 20}})"),
       {step(R"({"rotate": {"axis": [0, 0, 1], "degrees": 20}})")}},
      {"shape.transform.rotate.degrees",
       step(R"({"rotate": {"axis": [0, 0, 1], "degrees": 30}})"),
       {step(R"({"rotate": {"axis": [0, 0, 1], "degrees": 20}})")}},
      {"light.point.type",
       R"(lights.key={"name": "key", "type": "directional", "direction": [0, -1, 0], "irradiance": 2})"},
      {"light.point.name", "lights.panel.name=window"},
      {"light.point.position", "lights.key.position=[30, 90, 20]"},
      {"light.point.intensity", "lights.key.intensity=[3e4, 1e4, 5e3]"},
      {"light.spot.type", "lights.panel=" + kSpot},
      {"light.spot.position", "lights.light1.position=[20, 90, 20]", light(kSpot)},
      {"light.spot.direction", "lights.light1.direction=[1, -9, -2]", light(kSpot)},
      {"light.spot.intensity", "lights.light1.intensity=1e4", light(kSpot)},
      {"light.spot.outer_angle", "lights.light1.outer_angle=9", light(kSpot)},
      {"light.spot.inner_angle", "lights.light1.inner_angle=8", light(kSpot)},
      {"light.directional.type", "lights.panel=" + kSun},
      {"light.directional.name", "lights.light1.name=sun",
       light(R"({"type": "directional", "direction": [0, -2, -1], "irradiance": 2, "angle": 9})")},
      {"light.directional.direction", "lights.light1.direction=[1, -2, -1]", light(kSun)},
      {"light.directional.irradiance", "lights.light1.irradiance=[2, 1, 1]", light(kSun)},
      {"light.directional.angle", "lights.light1.angle=5", light(kSun)},
      {"light.directional.visible", "lights.light1.visible=false",
       light(R"({"type": "directional", "direction": [0, 0.03, 1], "irradiance": 2, "angle": 8})")},
      {"light.sphere.type", "lights.panel=" + kSphereLight},
      {"light.sphere.name", "lights.light1.name=bulb", light(kSphereLight)},
      {"light.sphere.center", "lights.light1.center=[30, 90, 20]", light(kSphereLight)},
      {"light.sphere.radius", "lights.light1.radius=12", light(kSphereLight)},
      {"light.sphere.radiance", "lights.light1.radiance=[20, 10, 5]", light(kSphereLight)},
      {"light.sphere.visible", "lights.light1.visible=false",
       light(R"({"type": "sphere", "center": [0, 28, 40], "radius": 9, "radiance": 20})")},
      {"light.quad.type", "lights.panel=" + kSphereLight},
      {"light.quad.name", "lights.panel.name=window"},
      {"light.quad.corner", "lights.panel.corner=[-30, 90, 30]"},
      {"light.quad.u", "lights.panel.u=[30, 0, 0]"},
      {"light.quad.v", "lights.panel.v=[0, 0, 30]"},
      {"light.quad.radiance", "lights.panel.radiance=[5, 3, 2]"},
      {"light.quad.visible", "lights.light1.visible=false",
       light(R"({"type": "quad", "corner": [-9, 20, 30], "u": [18, 0, 0], "v": [0, 18, 0], "radiance": 5})")},
      {"light.environment.type", "lights.panel=" + kRoom},
      {"light.environment.name", "lights.light1.name=room", light(kRoom)},
      {"light.environment.file", "lights.light1.file=night.exr", light(kRoom)},
      {"light.environment.strength", "lights.light1.strength=[2, 1, 1]", light(kRoom)},
      {"light.environment.rotation", "lights.light1.rotation=60", light(kRoom)},
      {"light.environment.visible", "lights.light1.visible=false", light(kRoom)},
      {"camera.position", "camera.position=[5, 30, 120]"},
      {"camera.look_at", "camera.look_at=[2, 8, 0]"},
      {"camera.up", "camera.up=[0.2, 1, 0]"},
      {"camera.orthographic_height", "camera.orthographic_height=60"},
      {"camera.shift", "camera.shift=[0.1, 0]"},
      {"camera.aperture", "camera.aperture=20"},
      {"camera.f_number", "camera.f_number=2"},
      {"camera.focus_distance", "camera.focus_distance=80", {"camera.aperture=20"}},
      {"camera.focus_point", "camera.focus_point=[0, 0, 40]", {"camera.aperture=20"}},
      {"camera.blades", "camera.blades=3", {"camera.aperture=20"}},
      {"camera.field_of_view", "camera.field_of_view=28"},
      {"film.resolution", "film.resolution=[15, 12]"},
      {"film.crop", "film.crop=[2, 2, 15, 10]"},
      {"film.pixel_aspect", "film.pixel_aspect=1.5"},
      {"film.samples_per_pixel", "film.samples_per_pixel=2"},
      {"film.shutter",
       "film.shutter=0.5",
       {R"(camera.position={"keyed": {"1": [0, 30, 120], "2": [9, 30, 120]}})"}},
      {"film.filter", "film.filter=gaussian", {"film.samples_per_pixel=2"}},
      {"settings.method", "settings.method=lambert"},
      {"settings.evaluator", "settings.evaluator=surface_cache"},
      {"settings.tolerance", "settings.tolerance=0.3"},
      {"settings.laboratory", R"(settings.laboratory={"near_field": false})"},
      {"settings.laboratory.max_solid_angle",
       "settings.laboratory.max_solid_angle=0.5",
       {"settings.evaluator=classic"}},
      {"settings.laboratory.near_field", "settings.laboratory.near_field=false"},
      {"settings.laboratory.near_irradiance", "settings.laboratory.near_irradiance=samples"},
      {"settings.sample_spacing",
       "settings.sample_spacing=4",
       {R"(settings={"method": "hierarchical", "sample_spacing": 6, "light_samples": 2})"}},
      {"settings.samples", "settings.samples=120"},
      {"settings.max_samples", "settings.max_samples=100", {"settings.sample_spacing=1"}},
      {"settings.light_samples", "settings.light_samples=6"},
      {"settings.cell_size", "settings.cell_size=2.5", {cells[0], cells[1]}},
      {"settings.cell_size",
       "settings.cell_size=2.5",
       {cells[0], cells[1], cells[2], "media.wax.texture_mix=medium",
        R"(media.wax.subsurface_color={"texture": "cells.png"})"}},
      {"texture.noise", noise("veins", R"("size": 4)"), clouds},
      {"texture.size", noise("clouds", R"("size": 3)"), clouds},
      {"texture.octaves", noise("clouds", R"("size": 4, "octaves": 2)"), clouds},
      {"texture.low", noise("clouds", R"("size": 4, "low": 0.3)"), clouds},
      {"texture.high", noise("clouds", R"("size": 4, "high": 0.5)"), clouds},
      {"texture.seed", noise("clouds", R"("size": 4, "seed": 2)"), clouds},
      {"texture.triplanar", texture(R"("triplanar": 9)")},
      {"texture.detail", texture(R"("detail": [{"texture": "other.png"}])")},
      {"texture.blend",
       texture(R"("detail": [{"texture": "other.png", "blend": "overlay"}])"),
       {texture(R"("detail": [{"texture": "other.png"}])")}},
      {"spectrum.nm", R"(media.stone.sigma_a={"nm": [450, 700], "values": [0.1, 0.01]})", spectrum},
      {"spectrum.values", R"(media.stone.sigma_a={"nm": [400, 700], "values": [0.1, 0.02]})", spectrum},
      {"spectrum.spectrum", R"(media.stone.sigma_a={"spectrum": "blood.txt"})", spectrum},
      {"spectrum.blackbody",
       R"(lights.panel.radiance={"blackbody": 4000})",
       {R"(lights.panel.radiance={"blackbody": 3000})"}},
      {"spectrum.illuminant",
       R"(lights.panel.radiance={"illuminant": "A"})",
       {R"(lights.panel.radiance={"illuminant": "E"})"}},
      {"spectrum.tissue", R"(media.stone.sigma_a={"tissue": {"blood": 0.01}})", spectrum},
      {"spectrum.tissue.melanin", R"(media.stone.sigma_a={"tissue": {"melanin": 0.02, "blood": 0.01}})",
       tissue},
      {"spectrum.tissue.eumelanin",
       R"(media.stone.sigma_a={"tissue": {"melanin": 0.01, "eumelanin": 0.2, "blood": 0.01}})", tissue},
      {"spectrum.tissue.blood", R"(media.stone.sigma_a={"tissue": {"melanin": 0.01, "blood": 0.05}})",
       tissue},
      {"spectrum.tissue.oxygenation",
       R"(media.stone.sigma_a={"tissue": {"melanin": 0.01, "blood": 0.01, "oxygenation": 0}})", tissue},
      {"spectrum.powers", R"(media.stone.sigma_s_prime={"powers": [[7000, -1.2]]})", spectrum},
      {"spectrum.scale",
       R"(lights.panel.radiance={"illuminant": "E", "scale": 3})",
       {R"(lights.panel.radiance={"illuminant": "E"})"}},
      {"spectrum.lm", "lights.key.intensity.lm=3e8", {R"(lights.key.intensity={"lm": 2e8})"}},
      {"spectrum.cd", "lights.key.intensity.cd=3e7", {R"(lights.key.intensity={"cd": 2e7})"}},
      {"spectrum.lx",
       "lights.panel.irradiance.lx=1e9",
       {R"(lights.panel={"type": "directional", "direction": [0, -2, -1], "irradiance": {"lx": 2e9}})"}},
      {"spectrum.nit", "lights.panel.radiance.nit=1e9", {R"(lights.panel.radiance={"nit": 2e9})"}},
      {"spectrum.color",
       "lights.panel.radiance.color=[1, 0.5, 0.2]",
       {R"(lights.panel.radiance={"nit": 2e9, "color": [1, 0.9, 0.8]})"}},
      {"film.wavelengths", "film.wavelengths=6", spectrum},
      {"settings.reenter", "settings.reenter=false", volume},
      {"settings.bounces", "settings.bounces=0"},
      {"settings.seed", "settings.seed=5"},
      {"settings.until_error", "settings.until_error=0.3"},
  };
}

/// Of the picture's file, of `direct`, of frames, names of what draws no random numbers, and twins that give the same bits.
const std::vector<std::string> kWithoutPicture{
    "scene.$schema",          "shape.name",
    "light.spot.name",        "film.pixel_type",
    "film.exposure",          "film.view",
    "film.color_space",       "settings.laboratory.entry_strategy",
    "settings.entry_samples", "settings.reference_frame",
    "film.denoise",           "settings.laboratory.instruction_set"};

/// "section.key", as Change has it.
std::string name_of(const KeyInfo& info) {
  return std::string(info.section) + '.' + std::string(info.key);
}

// An open box with a lid apart from it.
const char* const kBump = R"(
usemtl body
v -18 0 -6
v -6 0 -6
v -6 0 6
v -18 0 6
v -12 14 0
f 1 2 3
f 1 3 4
f 2 1 5
f 3 2 5
f 4 3 5
usemtl lid
v -18 16 -6
v -6 16 -6
v -12 16 6
v -12 22 0
f 6 7 8
f 7 6 9
f 8 7 9
f 6 8 9
)";

/// A cube of 8 mm that walks to the left in one animation, and in the other runs upwards.
std::string walking_cube() {
  asset_test::Asset asset = asset_test::cube_mesh();
  asset.root(asset.node({{"mesh", 0}, {"translation", {-12, 9, 0}}, {"scale", {4, 4, 4}}}));
  const int times = asset.accessor<float>("SCALAR", asset_test::kFloat, {0, 1});
  for (const auto& [name, end] :
       {std::pair("walk", std::array{-20.f, 9.f}), {"run", std::array{-12.f, 20.f}}}) {
    const int places = asset.accessor<float>("VEC3", asset_test::kFloat, {-12, 9, 0, end[0], end[1], 0});
    asset.json["animations"].push_back(
        {{"name", name},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  }
  return asset.glb();
}

Image picture(int width, int height, float step) {
  Image image;
  image.width = image.full_width = width;
  image.height = image.full_height = height;
  image.channels = {"R", "G", "B"};
  image.pixels.resize(std::size_t(width * height) * 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = std::fmod(.1f + step * float(i), 1.0f);
  return image;
}

// Claim: whatever key of a scene changes, the session's next picture is that of a new session, and another than before.
// Source: Session. Fails if: a kept result's key lacks a value that it was computed from. A new key is to be added here.
class EveryKey : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryKey, IsNoticed) {
  const ScratchFolder folder;
  put_bytes(folder.file("bump.obj"), kBump);
  put_bytes(folder.file("walk.glb"), walking_cube());
  put_bytes(folder.file("coloured.obj"),
            std::string(kBump).replace(std::string(kBump).find("14 0"), 4, "14 0 1 .2 .1"));
  write_png(folder.file("cells.png"), picture(8, 8, .37f), 0);
  write_png(folder.file("other.png"), picture(8, 8, .23f), 0);
  put_bytes(folder.file("blood.txt"), "400 0.2\n550 0.1\n700 0\n");
  write_exr(folder.file("room.exr"), picture(8, 4, .37f), false);
  write_exr(folder.file("night.exr"), picture(8, 4, .11f), false);
  const auto scene_with = [&](const Overrides& overrides) {
    return with_few_triangles(parse_scene(kScene, folder.file("scene.json"), overrides));
  };
  for (const Change& change : changes()) {
    if (!change.key.starts_with(GetParam())) continue;
    SCOPED_TRACE(change.key + ": " + change.override);
    Overrides after = change.before;
    after.push_back(change.override);
    try {
      Session session, fresh;
      session.hold_view(true);
      session.match_new_session(true);
      const Image old = picture_of(session, scene_with(change.before)),
                  edited = picture_of(session, scene_with(after)),
                  anew = picture_of(fresh, scene_with(after));
      EXPECT_TRUE(same_pixels(edited, anew));
      EXPECT_FALSE(same_pixels(edited, old));
    } catch (const Error& failure) {
      ADD_FAILURE() << failure.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, EveryKey,
                         ::testing::Values("scene", "medium", "shape", "texture", "light", "camera", "film",
                                           "settings"),
                         [](const auto& section) { return std::string(section.param); });

// Claim: the list above has every key. Source: the table of keys. Fails if: a key is added to the table alone.
TEST(KeysOfScenes, AreOnTheList) {
  const std::vector<Change> all = changes();
  for (const KeyInfo& info : schema()) {
    const bool is_there = std::ranges::any_of(all, [&](const Change& c) { return c.key == name_of(info); });
    const bool is_left_out = std::ranges::find(kWithoutPicture, name_of(info)) != kWithoutPicture.end();
    EXPECT_TRUE(is_there != is_left_out) << name_of(info);
  }
}

}  // namespace
}  // namespace opaline::test
