// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_estimate_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "input/presets.h"
#include "opaline/vec3.h"

namespace opaline {
namespace {

// Bodies are about this large, in scene units; mm_per_unit makes their size in mean free paths.
constexpr double kBodySize = 2;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit_double(hash_bits(seed_, ++n_)); }
  double spread(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
  std::size_t below(std::size_t n) { return std::min(n - 1, std::size_t(uniform(0, double(n)))); }
  bool chance(double p) { return uniform(0, 1) < p; }

  Vec3d direction() {
    const double z = uniform(-1, 1), phi = uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), z, r * std::sin(phi)};
  }

 private:
  std::uint64_t seed_, n_ = 0;
};

std::string list(const Vec3d& v) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z);
}

struct RandomMedium {
  std::string json;
  double longest = 0;  // mean free path, mm
};

RandomMedium random_medium(Dice& dice) {
  const std::string profile = dice.chance(.5) ? "dipole" : "normalized_diffusion";
  if (dice.chance(.65)) {
    const Preset& preset = measured_presets()[dice.below(measured_presets().size())];
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c)
      longest =
          std::max(longest, 1 / (preset.coefficients.sigma_a[c] + preset.coefficients.sigma_s_prime[c]));
    return {fmt::format(R"({{"preset": "{}", "profile": "{}"}})", preset.name, profile), longest};
  }
  Vec3d colour, radius;
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = dice.uniform(.1, .95);
    radius[c] = dice.spread(.2, 1);
  }
  return {
      fmt::format(
          R"({{"subsurface_color": {}, "subsurface_radius": {}, "specular_ior": {:.3g}, "profile": "{}"}})",
          list(colour), list(radius), dice.uniform(1.1, 1.6), profile),
      max_component(radius)};
}

struct RandomBody {
  std::string name;
  std::vector<std::string> shapes;
};

std::string shape(const std::string& name, const std::string& source, const std::string& more) {
  return fmt::format(R"({{"name": "{}", {}, "medium": "m"{}}})", name, source, more);
}

std::string turned(Dice& dice) {
  return fmt::format(R"({{"rotate": {{"axis": {}, "degrees": {:.4g}}}}})", list(dice.direction()),
                     dice.uniform(0, 360));
}

std::string transform(const std::string& steps) {
  return R"(, "transform": [)" + steps + "]";
}

RandomBody random_body(Dice& dice, const std::string& scenes_folder) {
  const auto sphere = [](const Vec3d& center, double radius) {
    return fmt::format(R"("sphere": {{"center": {}, "radius": {:.5g}}})", list(center), radius);
  };
  const std::string grouped = R"(, "group": "g")";
  switch (dice.below(10)) {
    case 0:
      return {"sphere", {shape("body", sphere({}, 1), "")}};
    case 1:
      return {"torus",
              {shape("body",
                     fmt::format(R"("torus": {{"major_radius": 0.8, "minor_radius": {:.3g}}})",
                                 dice.spread(.05, .4)),
                     transform(turned(dice)))}};
    case 2:
      return {"box",
              {shape("body",
                     R"("box": {"low": [-0.7, -0.7, -0.7], "high": [0.7, 0.7, 0.7]}, "normals": "faceted")",
                     transform(turned(dice)))}};
    case 3:
    case 4: {
      const std::string thin =
          fmt::format(R"("slab": {{"width": 2, "depth": 2, "thickness": {:.3g}}}, "normals": "faceted")",
                      dice.spread(.01, .2));
      return {"slab", {shape("body", thin, transform(turned(dice)))}};
    }
    case 5:
    case 6:
      return {"bunny",
              {shape("body",
                     fmt::format(R"("file": "{}/assets/bunny.obj", "fit_size": 2, "fill_holes": true)",
                                 scenes_folder),
                     transform(R"({"translate": [0, -1, 0]}, )" + turned(dice)))}};
    case 7: {
      const double inner = dice.uniform(.5, .97);
      return {"nested",
              {shape("outer", sphere({}, 1), grouped), shape("inner", sphere({.02, 0, 0}, inner), grouped)}};
    }
    case 8:
      return {
          "grouped",
          {shape("one", sphere({-.4, 0, 0}, .7), grouped),
           shape("two", R"("box": {"low": [-0.1, -0.5, -0.5], "high": [1, 0.5, 0.5]}, "normals": "faceted")",
                 grouped)}};
    default: {
      const double small = dice.spread(.05, .5);
      return {"two sizes",
              {shape("large", sphere({-.3, 0, 0}, .8), ""),
               shape("small", sphere(normalized(Vec3d{1, .5, 1}) * (.8 + small) + Vec3d{-.25, 0, 0}, small),
                     "")}};
    }
  }
}

/// Its side u x v looks at the origin.
std::string quad_at(Dice& dice, const Vec3d& from, double size) {
  const Vec3d towards = normalized(from) * -1.0;
  const Vec3d u = normalized(cross(towards, Vec3d{.3, .8, .52})) * size,
              v = cross(towards, u) * dice.uniform(.5, 1.5);
  return fmt::format(R"("type": "quad", "corner": {}, "u": {}, "v": {}, "radiance": 1)",
                     list(from - u * .5 - v * .5), list(u), list(v));
}

struct RandomLight {
  std::string kind, json;  // json: of the list; empty for the surroundings
};

/// eye: the direction to the camera; lamps leave the view free.
RandomLight random_light(Dice& dice, double mm_per_unit, const Vec3d& eye) {
  Vec3d towards = dice.direction();
  if (dot(towards, eye) < 0 && dice.chance(.5)) towards = towards * -1.0;
  const double distance = dice.spread(2.2, 8);
  const std::size_t kind = dice.below(5);
  const bool has_area = kind == 2 || kind == 3;
  if (has_area && dot(towards, eye) > .4) towards = normalized(towards - eye * (dot(towards, eye) - .3));
  switch (kind) {
    case 0:
      return {"point", fmt::format(R"({{"type": "point", "position": {}, "intensity": {:.4g}}})",
                                   list(towards * distance),
                                   std::pow(distance * mm_per_unit, 2) * dice.uniform(1, 3))};
    case 1:
      return {"directional",
              fmt::format(R"({{"type": "directional", "direction": {}, "irradiance": {:.3g}}})",
                          list(towards * -1.0), dice.uniform(1, 3))};
    case 2:
      return {"quad", "{" + quad_at(dice, towards * distance, distance * dice.spread(.1, 1)) + "}"};
    case 3:
      return {"sphere", fmt::format(R"({{"type": "sphere", "center": {}, "radius": {:.3g}, "radiance": 2}})",
                                    list(towards * distance), (distance - 1.2) * dice.spread(.05, .8))};
    default:
      return {"surroundings", ""};
  }
}

struct RandomLighting {
  std::string kinds, json;  // the members "lights" and perhaps "surroundings"
};

RandomLighting random_lighting(Dice& dice, double mm_per_unit, const Vec3d& eye) {
  std::vector<std::string> kinds, lights;
  bool surroundings = false;
  const std::size_t count = 1 + dice.below(2);
  for (std::size_t i = 0; i < count; ++i) {
    const RandomLight light = random_light(dice, mm_per_unit, eye);
    if (std::ranges::find(kinds, light.kind) == kinds.end()) kinds.push_back(light.kind);
    if (light.json.empty())
      surroundings = true;
    else
      lights.push_back(light.json);
  }
  std::ranges::sort(kinds);
  return {fmt::format("{}", fmt::join(kinds, " and ")),
          fmt::format(R"("lights": [{}]{})", fmt::join(lights, ", "),
                      surroundings ? R"(, "surroundings": 0.3)" : "")};
}

/// A floor, which throws light on nothing but catches and casts shadows, or nothing.
std::string random_blocker(Dice& dice) {
  const double which = dice.uniform(0, 1);
  if (which < .2)
    return R"({"name": "floor", "quad": {"corner": [-6, -1.1, -6], "u": [0, 0, 12], "v": [12, 0, 0]}})";
  if (which < .3)
    return fmt::format(
        R"({{"name": "blocker", "quad": {{"corner": {}, "u": [0.8, 0, 0], "v": [0, 0.5, 0.6]}}}})",
        list(dice.direction() * 1.9));
  return "";
}

}  // namespace

RandomPair random_pair(std::size_t index, const std::string& scenes_folder) {
  Dice dice(hash_bits(20, index));
  RandomPair pair;
  pair.length = dice.spread(.002, 5);
  const RandomMedium medium = random_medium(dice);
  const double mm_per_unit = medium.longest / (pair.length * kBodySize);
  const Vec3d eye = normalized(Vec3d{dice.uniform(-.5, .5), dice.uniform(-.2, .8), 1});
  RandomBody body = random_body(dice, scenes_folder);
  pair.body = body.name;
  const RandomLighting lighting = random_lighting(dice, mm_per_unit, eye);
  pair.lights = lighting.kinds;
  if (const std::string blocker = random_blocker(dice); !blocker.empty()) body.shapes.push_back(blocker);
  pair.samples_per_pixel = 1 << dice.below(9);
  pair.light_samples = int(std::lround(dice.spread(1, 256)));
  pair.samples = dice.chance(.25) ? "default" : fmt::format("{:.0f}", dice.spread(250, 100000));
  const double draw = dice.uniform(0, 1);
  pair.evaluator = draw < .35   ? "dual_tree"
                   : draw < .7  ? "surface_cache"
                   : draw < .85 ? "automatic"
                                : "classic";
  const int width = pair.samples_per_pixel > 64   ? 48
                    : pair.samples_per_pixel > 16 ? 64
                                                  : 64 + int(dice.below(65));
  std::string settings = fmt::format(R"("bounces": 0, "light_samples": {}, "evaluator": "{}", "seed": {})",
                                     pair.light_samples, pair.evaluator, index);
  settings += pair.samples == "default" ? R"(, "max_samples": 50000)" : R"(, "samples": )" + pair.samples;
  if (dice.chance(.3)) settings += fmt::format(R"(, "tolerance": {:.2g})", dice.spread(.001, .02));
  pair.json = fmt::format(
      R"(// Pair {} of bench_error_estimate: {}, mean free path {:.3g} of the body.
{{
  "mm_per_unit": {:.6g},
  "media": {{"m": {}}},
  "shapes": [{}],
  {},
  "camera": {{"position": {}, "field_of_view": 12}},
  "film": {{"resolution": [{}, {}], "samples_per_pixel": {}, "filter": "{}"}},
  "settings": {{{}}}
}}
)",
      index, pair.body, pair.length, mm_per_unit, medium.json, fmt::join(body.shapes, ",\n    "),
      lighting.json, list(eye * 12.0), width, width, pair.samples_per_pixel,
      dice.chance(.5) ? "box" : "gaussian", settings);
  return pair;
}

}  // namespace opaline
