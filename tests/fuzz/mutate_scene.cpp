// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutate_scene.h"

#include <array>
#include <cmath>
#include <map>

#include "input/schema.h"

namespace opaline::fuzz {
namespace {

template <class List>
const auto& any_of(const List& list, Random& random) {
  return *std::next(std::begin(list), std::ptrdiff_t(below(random, std::size(list))));
}

double uniform(Random& random, double low, double high) {
  return low + (high - low) * double(random() >> 11) * 0x1p-53;
}

/// Mostly of everyday size.
double magnitude(Random& random) {
  const double reach = random() % 4 == 0 ? 30 : random() % 3 == 0 ? 8 : 2;
  return std::pow(10, uniform(random, -reach, reach));
}

double signed_number(Random& random) {
  if (random() % 12 == 0) return 0;
  return (random() % 2 == 0 ? 1 : -1) * magnitude(random);
}

Json vector_of(Random& random) {
  if (random() % 3 == 0)
    return Json{double(below(random, 3)) - 1, double(below(random, 3)) - 1, double(below(random, 3)) - 1};
  const double scale = magnitude(random);
  return Json{uniform(random, -1, 1) * scale, uniform(random, -1, 1) * scale, uniform(random, -1, 1) * scale};
}

Json amounts(Random& random) {
  if (random() % 2 == 0) return magnitude(random);
  return Json{magnitude(random), magnitude(random), magnitude(random)};
}

/// Of a key whose values are names.
const std::vector<std::string>* names_of(const std::string& key) {
  static const std::map<std::string, std::vector<std::string>> names{
      {"method", {"hierarchical", "lambert", "direct"}},
      {"evaluator", {"dual_tree", "surface_cache", "automatic", "classic", "brute_force"}},
      {"instruction_set", {"automatic", "baseline"}},
      {"near_irradiance", {"samples", "point", "mixed"}},
      {"entry_strategy", {"disc_axes", "chords"}},
      {"profile", {"auto", "dipole", "normalized_diffusion", "multipole", "directional_dipole"}},
      {"fit", {"diffuse_entry", "searchlight", "dmfp", "refit"}},
      {"preset", {"marble", "skin1", "wholemilk", "spectralon", "ketchup"}},
      {"normals", {"smooth", "faceted"}},
      {"filter", {"box", "gaussian"}},
      {"pixel_type", {"half", "float"}},
      {"type", {"point", "directional", "sphere", "quad"}},
      {"medium", {"a", "b"}},
      {"group", {"one", "two"}},
      {"channel", {"r", "g", "b", "a"}},
      {"color_space", {"automatic", "srgb", "linear"}},
      {"texture_mix", {"pre", "post", "split", "medium"}},
  };
  const auto found = names.find(key);
  return found == names.end() ? nullptr : &found->second;
}

Json value_of(const std::string& key, Random& random);

Json object_of(const std::string& section, Random& random) {
  Json object = Json::object();
  for (const std::string_view key : section_keys(section))
    if (key != "name") object[std::string(key)] = value_of(std::string(key), random);
  return object;
}

Json transform_of(Random& random) {
  const std::string step(any_of(section_keys("shape.transform"), random));
  return Json{{step, value_of(step, random)}};
}

Json value_of(const std::string& key, Random& random) {
  if (const auto* names = names_of(key)) return any_of(*names, random);
  if (random() % 40 == 0)
    return any_of(std::array<Json, 6>{nullptr, true, "x", Json::array(), Json::object(), -1}, random);
  for (const char* vector : {"center", "low", "high", "corner", "u", "v", "position", "look_at", "up",
                             "direction", "axis", "translate"})
    if (key == vector) return vector_of(random);
  for (const char* color : {"sigma_a", "sigma_s", "sigma_s_prime", "intensity", "irradiance", "radiance",
                            "surroundings", "subsurface_radius", "subsurface_radius_scale"})
    if (key == color) return amounts(random);
  if (key == "reflectance" || key == "subsurface_color")
    return Json{uniform(random, 0, 1), uniform(random, 0, 1), double(below(random, 2))};
  if (key == "uv_scale" || key == "uv_offset") return Json{signed_number(random), signed_number(random)};
  if (key == "near_field" || key == "fill_holes") return random() % 2 == 0;
  if (key == "laboratory") return object_of("settings.laboratory", random);
  if (key == "rotate") return object_of("shape.transform.rotate", random);
  if (key == "transform") return Json{transform_of(random), transform_of(random)};
  if (key == "matrix") {
    const Json x = vector_of(random), y = vector_of(random), z = vector_of(random);
    return Json{{x[0], y[0], z[0], 0}, {x[1], y[1], z[1], 0}, {x[2], y[2], z[2], signed_number(random)}};
  }
  if (key == "crop") return Json{below(random, 16), below(random, 16), below(random, 18), below(random, 18)};
  if (key == "seed" || key == "reference_frame") return random() >> below(random, 64);
  if (!section_keys("shape." + key).empty()) return object_of("shape." + key, random);
  return random() % 4 == 0 ? signed_number(random) : magnitude(random);
}

Json shape_of(Random& random) {
  const std::string kind =
      any_of(std::array<std::string, 5>{"sphere", "box", "quad", "slab", "torus"}, random);
  Json shape{{kind, object_of("shape." + kind, random)}};
  if (random() % 2 == 0) shape["medium"] = value_of("medium", random);
  if (random() % 3 == 0) shape["transform"] = value_of("transform", random);
  if (random() % 4 == 0 && shape.contains("medium")) shape["group"] = value_of("group", random);
  return shape;
}

Json light_of(Random& random) {
  const std::string type = value_of("type", random);
  Json light = object_of("light." + type, random);
  light["type"] = type;
  return light;
}

/// The section of the schema that an object is of, by the keys that lead to it.
std::string section_at(const std::vector<std::string>& path, const Json& object) {
  if (path.empty()) return "scene";
  if (object.contains("texture")) return "texture";
  const std::string& first = path[0];
  if (first == "media") return path.size() == 2 ? "medium" : "";
  if (first == "lights") return path.size() == 2 ? "light." + object.value("type", Json("point")).dump() : "";
  if (first == "shapes") return path.size() == 2 ? "shape" : path.size() == 3 ? "shape." + path[2] : "";
  if (path.size() == 2 && path[1] == "laboratory") return "settings.laboratory";
  return path.size() == 1 ? first : "";
}

struct Place {
  Json* value;
  std::vector<std::string> path;
};

void collect(Json& value, const std::vector<std::string>& path, std::vector<Place>& places) {
  places.push_back({&value, path});
  if (!value.is_structured()) return;
  for (auto& [key, child] : value.items()) {
    std::vector<std::string> longer = path;
    longer.push_back(key);
    collect(child, longer, places);
  }
}

std::vector<Place> places_in(Json& scene) {
  std::vector<Place> places;
  collect(scene, {}, places);
  return places;
}

void change_number(Json& scene, Random& random) {
  std::vector<Place> numbers;
  for (const Place& place : places_in(scene))
    if (place.value->is_number()) numbers.push_back(place);
  if (numbers.empty()) return;
  Json& value = *any_of(numbers, random).value;
  const double before = value.get<double>();
  switch (below(random, 5)) {
    case 0:
      value = signed_number(random);
      break;
    case 1:
      value = -before;
      break;
    case 2:
      value = before * (1 + uniform(random, -1e-6, 1e-6));
      break;
    default:
      value = before * magnitude(random);
  }
}

void add_key(Json& scene, Random& random) {
  std::vector<Place> objects;
  for (const Place& place : places_in(scene))
    if (place.value->is_object()) objects.push_back(place);
  const Place& place = any_of(objects, random);
  std::string section = section_at(place.path, *place.value);
  std::erase(section, '"');
  const auto keys = section_keys(section);
  if (keys.empty()) return;
  const std::string key(any_of(keys, random));
  if (key != "name" && key != "file" && key != "texture") (*place.value)[key] = value_of(key, random);
}

void remove_something(Json& scene, Random& random) {
  const Place place = any_of(places_in(scene), random);
  if (place.value->is_object() && !place.value->empty())
    place.value->erase(
        std::next(place.value->begin(), std::ptrdiff_t(below(random, place.value->size()))).key());
  else if (place.value->is_array() && !place.value->empty())
    place.value->erase(below(random, place.value->size()));
}

void double_something(Json& scene, Random& random) {
  std::vector<Place> lists;
  for (const Place& place : places_in(scene))
    if (place.value->is_array() && !place.value->empty() && place.value->front().is_object())
      lists.push_back(place);
  if (lists.empty()) return;
  Json& list = *any_of(lists, random).value;
  Json copy = any_of(list, random);
  copy.erase("name");
  list.push_back(copy);
}

/// All shapes by one transform: far away, tiny, mirrored.
void transform_all(Json& scene, Random& random) {
  const Json step = transform_of(random);
  if (!scene.contains("shapes") || !scene["shapes"].is_array()) return;
  for (Json& shape : scene["shapes"]) {
    if (!shape.is_object()) continue;
    if (!shape.contains("transform") || !shape["transform"].is_array()) shape["transform"] = Json::array();
    shape["transform"].push_back(step);
  }
}

void change(Json& scene, Random& random) {
  const auto list = [&](const char* key) -> Json& {
    if (!scene.contains(key) || !scene[key].is_array()) scene[key] = Json::array();
    return scene[key];
  };
  switch (below(random, 16)) {
    case 0:
      return list("shapes").push_back(shape_of(random));
    case 1:
      return list("lights").push_back(light_of(random));
    case 2:
    case 3:
      return add_key(scene, random);
    case 4:
      return remove_something(scene, random);
    case 5:
      return double_something(scene, random);
    case 6:
      return transform_all(scene, random);
    case 7:
      scene["mm_per_unit"] = magnitude(random);
      return;
    case 8:
      if (!scene.contains("media") || !scene["media"].is_object()) scene["media"] = Json::object();
      scene["media"][random() % 2 == 0 ? "a" : "b"] =
          Json{{"sigma_a", amounts(random)}, {"sigma_s_prime", amounts(random)}};
      return;
    default:
      return change_number(scene, random);
  }
}

void keep_small(Json& scene, Random& random) {
  if (!scene.contains("film") || !scene["film"].is_object()) scene["film"] = Json::object();
  if (!scene.contains("settings") || !scene["settings"].is_object()) scene["settings"] = Json::object();
  scene["film"]["resolution"] = Json{16, 16};
  Json& settings = scene["settings"];
  if (random() % 8 != 0) settings["samples"] = 50 + below(random, 500);
  settings["max_samples"] = 2000;
  settings["light_samples"] = 1 + below(random, 16);
  settings["entry_samples"] = 16;
  settings.erase("until_error");
  scene["film"]["samples_per_pixel"] = 1 + below(random, 3);
}

}  // namespace

Json mutated_scene(Json scene, Random& random) {
  const std::size_t changes = 1 + below(random, 4);
  for (std::size_t i = 0; i < changes; ++i) change(scene, random);
  keep_small(scene, random);
  return scene;
}

}  // namespace opaline::fuzz
