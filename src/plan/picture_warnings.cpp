// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/picture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "diffusion/diffuse_profile.h"
#include "irradiance/shadow_batch.h"
#include "lights/light.h"
#include "render/camera_rays.h"
#include "scene/scene_properties.h"
#include "scene/source_place.h"
#include "values/override_key.h"

namespace opaline {
namespace {

// In units of white, after the exposure: below 16, below 64 and at 255 of a PNG's 255 levels.
constexpr float kAlmostBlack = 0.005f, kDark = 0.05f, kOverexposed = 1.1f;
constexpr double kWellExposed = 0.5;  // maximum of a well-exposed image
constexpr double kFarAway = 30;       // diagonals of all shapes

Bounds box_of(const World& world) {
  Bounds all;
  for (const Bounds& box : world.boxes) {
    all.low = component_min(all.low, box.low);
    all.high = component_max(all.high, box.high);
  }
  return all;
}

std::string point_text(const Vec3d& mm, double mm_per_unit) {
  const Vec3d p = mm / mm_per_unit;
  return fmt::format("[{:.4g},{:.4g},{:.4g}]", p.x, p.y, p.z);
}

std::size_t channel(const Image& image, const char* name) {
  return std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
}

/// Largest channel of each covered pixel, of every step-th pixel.
std::vector<float> brightness(const Image& image, std::size_t step) {
  const std::size_t stride = image.channels.size(), count = image.pixels.size() / stride;
  const std::size_t r = channel(image, "R"), g = channel(image, "G"), b = channel(image, "B"),
                    coverage = channel(image, "A"), depth = channel(image, "Z");
  std::vector<float> values;
  for (std::size_t p = 0; p < count; p += step) {
    const float* pixel = image.pixels.data() + p * stride;
    if (pixel[coverage] > 0 && pixel[depth] != 0)
      values.push_back(std::max({pixel[r], pixel[g], pixel[b]}) / pixel[coverage]);
  }
  return values;
}

/// Odd step to about 65,000 pixels.
std::size_t sampling_step(const Image& image) {
  constexpr std::size_t enough = 65536;
  return (image.pixels.size() / image.channels.size() / enough) | 1;
}

/// Brightness is estimated from some pixels; all are searched for covered ones.
std::vector<float> sampled_brightness(const Image& image) {
  const std::size_t step = sampling_step(image);
  std::vector<float> values = brightness(image, step);
  return values.empty() && step > 1 ? brightness(image, 1) : values;
}

/// A visible point, by the camera's rays.
struct Seen {
  Vec3d place;     ///< mm
  bool is_behind;  ///< by the shading normal
};

/// At some of the pixels.
std::vector<Seen> seen_points(const Image& image, const Camera& camera) {
  std::optional<Vec3d> parallel;  // direction of all rays
  if (camera.orthographic_height) parallel = camera.look_at - camera.position;
  const std::size_t stride = image.channels.size(), coverage = channel(image, "A");
  const std::array<std::size_t, 3> normal{channel(image, "N.X"), channel(image, "N.Y"),
                                          channel(image, "N.Z")},
      place{channel(image, "P.X"), channel(image, "P.Y"), channel(image, "P.Z")};
  std::vector<Seen> seen;
  if (normal[2] == stride || place[2] == stride) return seen;
  for (std::size_t at = 0; at < image.pixels.size(); at += stride * sampling_step(image)) {
    const float* const pixel = image.pixels.data() + at;
    if (pixel[coverage] < 1) continue;
    const auto vector = [&](const std::array<std::size_t, 3>& of) {
      return Vec3d(double(pixel[of[0]]), double(pixel[of[1]]), double(pixel[of[2]]));
    };
    seen.push_back(
        {vector(place), dot(vector(normal), parallel.value_or(vector(place) - camera.position)) > 0});
  }
  return seen;
}

/// True if most of the points show a back. Smooth normals at sharp edges turn a few.
bool are_mostly_backs(std::span<const Seen> seen) {
  return 2 * std::size_t(std::ranges::count_if(seen, &Seen::is_behind)) > seen.size();
}

/// Open translucent mesh seen from behind, or camera inside a body; empty: neither. Opaque surfaces have no back.
std::string backs_are_seen(const Scene& scene, const World& world, const Image& image) {
  if (std::ranges::none_of(scene.shapes, [](const Shape& shape) { return shape.medium.has_value(); }))
    return {};
  const std::vector<Seen> seen = seen_points(image, scene.camera);
  constexpr double kRounding = 1e-4;      // diagonals
  constexpr double kConsiderable = 0.02;  // fraction of the points
  for (std::size_t m = 0; m < world.meshes.size(); ++m) {
    if (!scene.shapes[m].medium || world.reports[m].open_edges == 0) continue;
    const Vec3d margin(kRounding * length(world.boxes[m].high - world.boxes[m].low));
    const Bounds box{world.boxes[m].low - margin, world.boxes[m].high + margin};
    std::vector<Seen> own;
    for (const Seen& point : seen)
      if (meet(box, {point.place, point.place})) own.push_back(point);
    if (double(own.size()) > kConsiderable * double(seen.size()) && are_mostly_backs(own))
      return fmt::format(
          "the camera sees the back side of the open translucent mesh '{}', which is black: its winding "
          "faces away; vertex normals towards the camera turn it, or close the mesh",
          scene.shapes[m].name);
  }
  if (!are_mostly_backs(seen)) return {};
  return "the camera sees the back side of a translucent surface: it is inside the body; move the camera";
}

std::string nothing_in_view(const Scene& scene, const World& world) {
  const Bounds box = box_of(world);
  const Camera& camera = scene.camera;
  const Vec3d middle = .5 * (box.low + box.high), towards = middle - camera.position;
  const double distance = length(towards), radius = world.diagonal * world.unit / 2;
  const double cosine = dot(normalized(towards), normalized(camera.look_at - camera.position));
  const CameraRays::FilmPlace seen =
      CameraRays(camera, scene.film, world).film_place(into_world(world, middle));
  const auto [width, height] = scene.film.resolution;
  const bool is_in_view = seen.depth > 0 && seen.x >= 0 && seen.x <= width && seen.y >= 0 && seen.y <= height;
  const double pixels =
      2 * radius / world.unit / pixel_width(camera, scene.film, world).at(distance / world.unit);
  const double degrees = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
  std::string where = fmt::format("{:.0f} degrees from the view direction", degrees);
  if (scene.film.crop && degrees < 90)
    where = fmt::format("around the pixel {:.0f},{:.0f} of {} x {}", seen.x, seen.y, width, height);
  else if (distance <= radius)
    where = "around the camera";
  else if (degrees > 90)
    where = "behind the camera";
  else if (pixels < 2)
    where = fmt::format("so far away that together they are {:.2g} pixels wide", pixels);
  else if (is_in_view)
    where = "in the view, but possibly behind a light or thinner than a pixel";
  const std::string look = "--set camera.look_at=" + point_text(middle, scene.mm_per_unit);
  std::string advice = look + " centres them";
  if (scene.film.crop) {
    advice = "render without a crop, at a small --resolution, to locate them";
  } else if (distance <= radius) {
    const double far = 1.2 * radius / std::sin(camera.field_of_view * std::numbers::pi / 360);
    const Vec3d back = distance > 0 ? normalized(towards) : normalized(camera.look_at - camera.position);
    advice = fmt::format("{} --set camera.position={} views them from outside", look,
                         point_text(middle - back * far, scene.mm_per_unit));
  } else if (is_in_view && pixels >= 2) {
    advice = "move the light, set \"visible\": false for it, or choose a higher --resolution";
  } else if (pixels < 2 && camera.orthographic_height) {
    advice = fmt::format("{} --set camera.orthographic_height={:.4g} shows them", look,
                         2 * radius / scene.mm_per_unit);
  } else if (distance > radius && degrees <= 90 && pixels < 2) {
    const double near = radius / std::sin(camera.field_of_view * std::numbers::pi / 360);
    advice = fmt::format("{} --set camera.position={} shows them", look,
                         point_text(middle - towards * (near / distance), scene.mm_per_unit));
  }
  return fmt::format("no shape is visible{}: the shapes are between {} and {} (scene units), {}; {}",
                     scene.film.crop ? " in the crop" : "", point_text(box.low, scene.mm_per_unit),
                     point_text(box.high, scene.mm_per_unit), where, advice);
}

/// True if the light emits nothing, nor do its other channels if it has a texture.
bool is_dark(const Scene& scene, std::size_t light) {
  if (light >= scene.lights.size()) return true;
  const std::span<const Light> channels = std::span(scene.lights).subspan(light);
  return std::ranges::all_of(channels.first(sharing_rays(channels)),
                             [](const Light& one) { return emission(one) == Rgb{}; });
}

/// Problems of single lights, if the image is too dark.
std::vector<std::string> weak_lights(const Scene& scene, const World& world) {
  const Bounds box = box_of(world);
  const Vec3d middle = .5 * (box.low + box.high);
  std::vector<std::string> texts;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const Light& light = scene.lights[l];
    if (l > 0 && share_rays(scene.lights[l - 1], light)) continue;  // another channel of a texture
    const std::optional<Vec3d> place = is_of_shape(light) ? std::nullopt : extent(light).center;
    const double distance = place ? length(*place - middle) : 0;
    if (is_dark(scene, l) &&
        std::ranges::all_of(scene.other_wavelengths, [&](const Scene& other) { return is_dark(other, l); }))
      texts.push_back(fmt::format("the light {} emits nothing", light.name));
    else if (distance > kFarAway * world.diagonal * world.unit)
      texts.push_back(fmt::format(
          "the light {} is {:.3g} scene units away from the shapes, whose total extent is {:.3g}", light.name,
          distance / scene.mm_per_unit, world.diagonal * world.unit / scene.mm_per_unit));
  }
  return texts;
}

/// Point lights fall off with the square of the distance in mm, whatever the scene's unit: the usual cause of
/// a brightness wrong by the square of the unit.
std::string unit_text(const Scene& scene, double brightest) {
  const double factor = scene.mm_per_unit * scene.mm_per_unit, meant = brightest * factor;
  const bool has_points = std::ranges::any_of(scene.lights, [](const Light& light) {
    return is_delta(light) && extent(light).center && emission(light) != Rgb{};
  });
  if (!has_points || factor == 1 || meant < double(kAlmostBlack) || meant > 100) return {};
  return fmt::format(
      "; mm_per_unit is {:g}, but intensity / distance^2 is in W/mm^2: multiply an intensity given for scene "
      "units by {:g}",
      scene.mm_per_unit, factor);
}

/// "; use --exposure 7"
std::string exposure_text(const Scene& scene, double brightest) {
  const double stops =
      std::clamp(scene.film.exposure + std::round(std::log2(kWellExposed / brightest)), -100.0, 100.0);
  return fmt::format("; use --exposure {:g}", stops);
}

/// True if a medium is black; the plan already warns of it.
bool has_black_medium(const Scene& scene) {
  return std::ranges::any_of(scene.shapes, [&](const Shape& shape) {
    return shape.medium && !make_diffuse_profile(scene.media[*shape.medium]).translucent;
  });
}

bool is_black(const Rgb& color, const std::optional<Texture>& texture) {
  return color == Rgb{} || (texture && texture->scale == Vec3d{});
}

/// Why a surface stays black in any light: "the tint of medium wax is 0"; empty: it does not.
std::string cause_of_black(const Scene& scene, const Shape& shape) {
  if (has_bright_fuzz(scene, shape)) return {};
  if (shape.medium) {
    const Medium& medium = scene.media[*shape.medium];
    const auto* artist = std::get_if<ArtistMedium>(&medium.coefficients);
    const bool is_opaque = is_partly_opaque(medium) && !is_black(medium.base_color, medium.base_texture);
    if (!is_opaque &&
        (is_black(medium.tint, medium.tint_texture) || (artist && artist->subsurface_color == Rgb{})))
      return "the colour of the medium " + medium.name + " is 0";
    return {};
  }
  if (is_black(shape.reflectance, shape.reflectance_texture))
    return "the reflectance of " + shape.name + " is 0";
  if (shape.gloss && shape.gloss->metalness == 1)
    return shape.name + " is a metal, which shows reflections only";
  return {};
}

/// Causes, if every shape has one.
std::string black_surfaces(const Scene& scene) {
  std::string text;
  for (const Shape& shape : scene.shapes) {
    const std::string cause = cause_of_black(scene, shape);
    if (cause.empty()) return {};
    if (text.find(cause) == text.npos) text += (text.empty() ? "" : "; ") + cause;
  }
  return text;
}

std::string too_dark(const Scene& scene, const World& world, double brightest) {
  const std::vector<std::string> causes = weak_lights(scene, world);
  std::string text = "black";
  if (brightest > 0)
    text = fmt::format("almost black: the maximum of the object is {:.2g} x white{}{}", brightest,
                       exposure_text(scene, brightest), unit_text(scene, brightest));
  else if (const std::string black = black_surfaces(scene); !black.empty())
    text += ": " + black;
  else if (causes.empty() && lights_that_miss(scene, world).empty() && !has_black_medium(scene))
    text +=
        ": no light reaches the visible surfaces; all lights may be behind them, inside a shape, "
        "in shadow or too weak";
  for (const std::string& cause : causes) text += "; " + cause;
  return "the object is " + text;
}

using Corners = std::array<Vec3d, 3>;

/// Largest positive cosine between a unit axis and the directions from the origin to points of an edge.
double largest_cosine(const Vec3d& a, const Vec3d& b, const Vec3d& axis) {
  const Vec3d edge = b - a;
  const double along = dot(edge, axis), start = dot(a, axis), both = dot(a, edge);
  const double place = (along * dot(a, a) - start * both) / (start * dot(edge, edge) - along * both);
  double largest = -1;
  for (const double t : {0., std::isfinite(place) ? std::clamp(place, 0., 1.) : 0., 1.}) {
    const Vec3d point = a + edge * t;
    largest = std::max(largest, dot(point, axis) / length(point));
  }
  return largest;
}

/// True if a cone with its apex at the origin and a triangle intersect: an edge is in it, or its axis passes
/// through the triangle.
bool meets_cone(const Corners& corners, const Vec3d& axis, double least_cosine) {
  const auto& [a, b, c] = corners;
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
    if (largest_cosine(from, to, axis) > least_cosine) return true;
  const double sides[3] = {dot(axis, cross(a, b)), dot(axis, cross(b, c)), dot(axis, cross(c, a))};
  const bool is_within =
      (sides[0] > 0 && sides[1] > 0 && sides[2] > 0) || (sides[0] < 0 && sides[1] < 0 && sides[2] < 0);
  const Vec3d normal = cross(b - a, c - a);
  return is_within && dot(axis, normal) * dot(a, normal) > 0;
}

/// True if the light's half space or cone contains a surface, in shadow or not.
bool reaches_a_surface(const Light& light, const World& world) {
  constexpr double kGrazing = 1e-6;  // diagonals
  const LightExtent lamp = extent(light);
  if (!lamp.facing) return true;
  const Vec3d center = into_world(world, *lamp.center), axis = *lamp.facing;
  const auto* const spot = std::get_if<SpotLight>(&light.source);
  const auto is_met = [&](const Corners& corners) {
    if (spot != nullptr)
      return meets_cone(corners, axis, std::cos(spot->outer_angle * std::numbers::pi / 180));
    return std::ranges::any_of(
        corners, [&](const Vec3d& corner) { return dot(axis, corner) > kGrazing * world.diagonal; });
  };
  return std::ranges::any_of(world.meshes, [&](const Mesh& mesh) {
    return std::ranges::any_of(mesh.triangles, [&](const auto& t) {
      return is_met(
          {mesh.positions[t[0]] - center, mesh.positions[t[1]] - center, mesh.positions[t[2]] - center});
    });
  });
}

/// Advice for a light reaching no surface.
std::string way_to_turn(const Scene& scene, const World& world, const Light& light) {
  if (!is_delta(light)) return "it emits on the side of u x v; exchange u and v";
  const Bounds box = box_of(world);
  std::size_t index = 0;  // in the file, where the channels of an environment are one light
  for (std::size_t l = 0; &scene.lights[l] != &light; ++l)
    index += scene.lights[l].name != scene.lights[l + 1].name ? 1 : 0;
  return fmt::format("its cone misses all shapes; --set lights.{}.direction={} points it at their centre",
                     override_key(light.name, index),
                     point_text(.5 * (box.low + box.high) - *extent(light).center, scene.mm_per_unit));
}

}  // namespace

std::vector<std::string> picture_warnings(const Scene& scene, const World& world, const Image& image) {
  if (world.meshes.empty() || scene.lights.empty()) return {};  // the plan warns of this
  std::vector<float> values = sampled_brightness(image);
  const auto is_hidden = [](const Shape& shape) { return !shape.is_seen || shape.catches_shadows; };
  if (values.empty() && std::ranges::any_of(scene.shapes, is_hidden)) return {};
  if (values.empty()) return {nothing_in_view(scene, world)};
  if (std::string backs = backs_are_seen(scene, world, image); !backs.empty()) return {std::move(backs)};
  const double gain = std::exp2(scene.film.exposure);
  const auto quantile = [&](double share) {
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::ranges::nth_element(values, at);
    return double(*at) * gain;
  };
  const double usual = quantile(.5);
  double brightest = quantile(.99);
  if (brightest < double(kAlmostBlack))  // a small part may be bright
    brightest = double(std::ranges::max(brightness(image, 1))) * gain;
  if (brightest < double(kAlmostBlack)) return {too_dark(scene, world, brightest)};
  if (brightest < double(kDark))
    return {fmt::format("the image is dark: 99 % of the visible surface is at most {:.2g} x white{}{}",
                        brightest, exposure_text(scene, brightest), unit_text(scene, brightest))};
  if (usual > double(kOverexposed))
    return {fmt::format("half of the object is overexposed ({:.2g} x white){}{}", usual,
                        exposure_text(scene, usual), unit_text(scene, usual))};
  return {};
}

std::vector<std::string> lights_that_miss(const Scene& scene, const World& world) {
  std::vector<std::string> texts;
  if (world.meshes.empty()) return texts;
  for (const Light& light : scene.lights)
    if (!reaches_a_surface(light, world))
      texts.push_back(text_at(light.place, fmt::format("the light {} reaches no surface: {}", light.name,
                                                       way_to_turn(scene, world, light))));
  return texts;
}

}  // namespace opaline
