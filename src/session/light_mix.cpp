// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/light_mix.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "opaline/core/parallel.h"
#include "opaline/lights/light.h"
#include "opaline/render/layers.h"

namespace opaline {
namespace {

Scene without_colours(Scene scene) {
  for (Light& light : scene.lights) light = with_emission(light, {});
  return scene;
}

bool has_room(const Film& film, std::size_t images) {
  const std::size_t channels = layer_names(Method::hierarchical).size();
  return images * channels * sizeof(float) * std::size_t(film.resolution[0]) *
             std::size_t(film.resolution[1]) <=
         kMostMixBytes;
}

// Which colour of light each channel of a picture adds up; none: it is the same in all light.
constexpr std::size_t kNoColour = 3;
std::vector<std::size_t> colours_of(const std::vector<std::string>& channels) {
  std::vector<std::size_t> colours;
  for (const std::string& channel : channels) {
    const bool is_light = channel.size() == 1 || channel.starts_with("diffuse.") ||
                          channel.starts_with("specular.") || channel.starts_with("irradiance.") ||
                          channel.starts_with("error.");
    const std::size_t colour = std::string_view("RGB").find(channel.back());
    colours.push_back(is_light && colour < 3 ? colour : kNoColour);
  }
  return colours;
}

// to += from x scale
void add_scaled(Image& to, const Image& from, const Rgb& scale) {
  std::vector<float> scales;
  for (const std::size_t colour : colours_of(to.channels))
    scales.push_back(colour == kNoColour ? 0 : float(scale[colour]));
  const std::size_t channels = scales.size(), row = std::size_t(to.width) * channels;
  parallel_chunks(std::size_t(to.height), 16, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin * row; i < end * row; i += channels)
      for (std::size_t c = 0; c < channels; ++c) to.pixels[i + c] += from.pixels[i + c] * scales[c];
  });
}

// The picture in no light at all.
Image black_out(Image image) {
  const std::vector<std::size_t> colours = colours_of(image.channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (colours[i % colours.size()] != kNoColour) image.pixels[i] = 0;
  return image;
}

}  // namespace

bool LightMix::is_single(std::size_t light) const {
  return std::ranges::find(single_, light, &Part::light) != single_.end();
}

std::optional<Image> LightMix::mixed(const Scene& scene, const Render& render) {
  LightMix next = std::exchange(*this, {});  // should a part fail, nothing half done is left
  const auto start_over = [&]() -> std::optional<Image> {
    last_ = scene;
    return {};
  };
  if (!next.last_ || without_colours(*next.last_) != without_colours(scene)) return start_over();
  const std::vector<Light> before = std::exchange(next.last_->lights, scene.lights);
  if (before != scene.lights) ++next.recoloured_;
  std::optional<Image> image;
  if (next.recoloured_ >= 2 || (next.recoloured_ == 1 && next.others_)) {
    std::vector<std::size_t> changed;
    for (std::size_t l = 0; l < scene.lights.size(); ++l)
      if (!next.is_single(l) && before[l] != scene.lights[l]) changed.push_back(l);
    if (!next.separate(scene, changed, render)) return start_over();
    image = next.others_;
    for (const Part& part : next.single_) add_scaled(*image, part.image, emission(scene.lights[part.light]));
  }
  *this = std::move(next);
  return image;
}

void LightMix::get_ready(const Scene& scene, const Render& render) {
  LightMix next;
  next.last_ = scene;
  std::vector<std::size_t> all(scene.lights.size());
  std::iota(all.begin(), all.end(), std::size_t(0));
  next.separate(scene, all, render);
  *this = std::move(next);
}

bool LightMix::separate(const Scene& scene, const std::vector<std::size_t>& lights, const Render& render) {
  if (lights.empty()) return true;
  if (!has_room(scene.film, single_.size() + lights.size() + 2)) return false;
  for (const std::size_t l : lights) {
    Scene alone = without_colours(scene);
    alone.lights[l] = with_emission(alone.lights[l], Rgb(1));
    single_.push_back({l, render(alone)});
  }
  Scene rest = scene;
  for (const Part& part : single_) rest.lights[part.light] = with_emission(rest.lights[part.light], {});
  const bool is_dark = rest.lights == without_colours(scene).lights;
  others_ = is_dark ? black_out(single_[0].image) : render(rest);
  return true;
}

}  // namespace opaline
