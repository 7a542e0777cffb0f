// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/light_groups.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "image/add_channels.h"
#include "lights/light.h"
#include "opaline/error.h"
#include "scene/names.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 3> kKinds{"diffuse", "specular", "emission"};
constexpr const char* kBackdrop = "backdrop";
// Relative rounding error of a sum of floats.
constexpr float kRounding = 1e-6f;

std::string layer_name(const std::string& light) {
  std::string name;
  for (const char c : light) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

Error refused(const SourcePlace& place, const std::string& what, const std::string& expected,
              const std::string& got = {}) {
  return Error(ErrorKind::bad_input, place.file, place.line, place.column, "light groups: " + what, expected,
               got);
}

/// First red channel of each kind of a group, in an image's pixels.
struct GroupPlaces {
  std::array<std::size_t, 3> kinds;
  std::size_t count;  ///< number of kinds; emission is last
};

std::vector<GroupPlaces> append_layers(Image& picture, std::span<const LightGroup> groups) {
  std::vector<GroupPlaces> all;
  std::vector<std::string> names;
  for (const LightGroup& group : groups) {
    GroupPlaces& places =
        all.emplace_back(GroupPlaces{{}, group.is_seen ? kKinds.size() : kKinds.size() - 1});
    for (std::size_t k = 0; k < places.count; ++k) {
      places.kinds[k] = picture.channels.size() + names.size();
      for (const char* channel : {".R", ".G", ".B"})
        names.push_back(std::string(kKinds[k]) + '_' + group.layer + channel);
    }
  }
  add_channels(picture, names);
  return all;
}

/// Reads diffuse, specular and the rest of R, G, B from an image of all layers.
class PixelReader {
 public:
  explicit PixelReader(const Image& image)
      : image_(image),
        color_(channel_place(image, "R")),
        diffuse_(channel_place(image, "diffuse.R")),
        specular_(channel_place(image, "specular.R")) {}

  float value(std::size_t pixel, std::size_t kind, std::size_t c) const {
    const float* const at = image_.pixels.data() + pixel * image_.channels.size() + c;
    if (kind < 2) return at[kind == 0 ? diffuse_ : specular_];
    const float emitted = at[color_] - at[diffuse_] - at[specular_];
    return emitted > kRounding * at[color_] ? emitted : 0;
  }

 private:
  const Image& image_;
  std::size_t color_, diffuse_, specular_;
};

void copy_group(const Image& alone, const GroupPlaces& places, Image& picture) {
  const PixelReader read(alone);
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
  parallel_chunks(pixels, 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < places.count; ++k)
        for (std::size_t c = 0; c < 3; ++c)
          if (const float value = read.value(i, k, c); value != 0)
            picture.pixels[i * picture.channels.size() + places.kinds[k] + c] = value;
  });
}

/// Scales the groups' values of one kind and channel to a sum.
void scale_to(float total, float* pixel, std::span<const GroupPlaces> groups, std::size_t kind,
              std::size_t c) {
  double sum = 0;
  float* first = nullptr;
  for (const GroupPlaces& group : groups) {
    if (kind >= group.count) continue;
    float& value = pixel[group.kinds[kind] + c];
    if (first == nullptr) first = &value;
    sum += double(value);
  }
  if (first == nullptr || double(total) == sum) return;
  const double factor = double(total) / sum;
  if (!(sum > 0) || !std::isfinite(factor)) {
    *first = total;  // too little light to scale
    return;
  }
  for (const GroupPlaces& group : groups)
    if (kind < group.count)
      pixel[group.kinds[kind] + c] = float(double(pixel[group.kinds[kind] + c]) * factor);
}

void scale_to_picture(Image& picture, std::span<const GroupPlaces> groups) {
  const PixelReader read(picture);
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height),
                    step = picture.channels.size();
  parallel_chunks(pixels, 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < kKinds.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c)
          scale_to(read.value(i, k, c), picture.pixels.data() + i * step, groups, k, c);
  });
}

void darken_others(Scene& scene, const LightGroup& group) {
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    if (std::ranges::find(group.lights, l) == group.lights.end())
      scene.lights[l] = with_emission(scene.lights[l], {});
  if (scene.backdrop && group.layer != kBackdrop) scene.backdrop = Rgb{};
  for (Scene& other : scene.other_wavelengths) darken_others(other, group);
}

Scene lit_by(Scene scene, const LightGroup& group) {
  darken_others(scene, group);
  return scene;
}

}  // namespace

std::vector<LightGroup> light_groups(const Scene& scene) {
  const Method method = scene.settings.method;
  if (!method_of(method).separates_lights())
    throw refused({scene.file}, "noise differs between lights with this method",
                  "--method volume_diffusion, or another than direct and volume",
                  std::string(name_of(method)));
  if (scene.lights.empty()) throw refused({scene.file}, "the scene has no lights", "a light");
  for (const Shape& shape : scene.shapes)
    if (shape.catches_shadows)
      throw refused(shape.place, "a shadow catcher shows the shadows of all lights together",
                    "no shadow_catcher");
  std::vector<LightGroup> groups;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const Light& light = scene.lights[l];
    const std::string layer = layer_name(light.name);
    const auto same = std::ranges::find(groups, layer, &LightGroup::layer);
    LightGroup& group = same != groups.end() ? *same : groups.emplace_back(LightGroup{layer, {}, false});
    if (!group.lights.empty() && scene.lights[group.lights[0]].name != light.name)
      throw refused(light.place, "two lights have the same layer \"" + layer + "\"",
                    "names that differ in letters or digits",
                    '"' + scene.lights[group.lights[0]].name + "\" and \"" + light.name + '"');
    group.lights.push_back(l);
    group.is_seen = group.is_seen || !is_delta(light);
  }
  if (scene.backdrop && *scene.backdrop != Rgb{}) {
    if (std::ranges::find(groups, kBackdrop, &LightGroup::layer) != groups.end())
      throw refused({scene.file}, "a light and the backdrop have the same layer",
                    "another name of the light");
    groups.push_back({kBackdrop, {}, true});
  }
  return groups;
}

void add_light_groups(Session& session, Image& picture, Monitor* monitor) {
  const Scene whole = session.scene();
  const std::vector<LightGroup> groups = light_groups(whole);
  const std::vector<GroupPlaces> places = append_layers(picture, groups);
  if (groups.size() == 1) return copy_group(picture, places[0], picture);
  const auto restore = [&] {
    session.repeat_adaptive_rays(false);
    session.edit(whole);
  };
  try {
    session.repeat_adaptive_rays(true);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      session.edit(lit_by(whole, groups[g]));
      copy_group(session.render(monitor).image, places[g], picture);
    }
  } catch (...) {
    restore();
    throw;
  }
  restore();
  session.prepare(monitor);
  scale_to_picture(picture, places);
}

}  // namespace opaline
