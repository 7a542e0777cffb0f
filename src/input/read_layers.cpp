// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "diffusion/diffuse_profile.h"
#include "diffusion/layered_medium.h"
#include "image/texture_file.h"
#include "input/readers.h"
#include "scene/scene_properties.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

const Medium& medium_of(const Value& name, std::span<const Medium> media, const Medium& owner) {
  const std::string wanted = name.string();
  const auto found = std::ranges::find(media, wanted, &Medium::name);
  if (found == media.end()) {
    std::string names;
    for (const Medium& medium : media)
      if (medium.name != owner.name) names += (names.empty() ? "" : ", ") + printable(medium.name);
    name.fail("names no medium of this scene",
              names.empty() ? "another medium in 'media'" : "one of " + names);
  }
  if (found->name == owner.name) name.fail("is the medium itself", "another medium in 'media'");
  if (varies_inside(*found)) name.fail("is not homogeneous", "a medium without textures and layers");
  return *found;
}

PhysicalMedium coefficients_of(const Medium& medium) {
  if (const auto* physical = std::get_if<PhysicalMedium>(&medium.coefficients)) return *physical;
  const DiffuseProfile profile = make_diffuse_profile(medium);
  PhysicalMedium result{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double length = profile.mean_free_path[c], fading = length / profile.diffuse_mean_free_path[c];
    if (!(length > 0)) continue;
    const double absorbed = std::min(1., fading * fading / 3);
    result.sigma_a[c] = absorbed / length;
    result.sigma_s_prime[c] = (1 - absorbed) / length;
  }
  return result;
}

double mean_of(const Texture& texture) {
  return std::max(0., texture.source->mean()[texture.channel] * texture.scale.x);
}

/// Keys of a medium without effect in a layer: only its coefficients count.
std::string keys_without_effect(const Medium& layer) {
  std::vector<std::string> keys;
  if (layer.tint_texture)
    keys.push_back("texture of its colour");
  else if (layer.tint != Rgb{1, 1, 1})
    keys.push_back("'tint'");
  if (layer.subsurface_weight < 1 || layer.weight_texture) keys.push_back("'subsurface_weight'");
  if (layer.fuzz.weight > 0) keys.push_back("'fuzz_weight'");
  return fmt::format("{}", fmt::join(keys, ", "));
}

void read_thickness(const Value& value, double mm_per_unit, MediumLayer& layer) {
  layer.thickness = 1;
  read_textured(value, layer.thickness, layer.thickness_texture);
  layer.thickness *= mm_per_unit;
  if (layer.thickness_texture) layer.mean_factor = mean_of(*layer.thickness_texture);
}

}  // namespace

void read_layers(const Value& value, double mm_per_unit, std::span<const Medium> media, Medium& medium,
                 std::vector<std::string>& warnings) {
  const ObjectReader reader(value, "medium");
  const auto layers = reader.find("layers");
  if (!layers) return;
  const std::vector<Value> list = layers->list();
  if (list.empty()) layers->fail("has no layer", "at least one");
  medium.layers.clear();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const ObjectReader one(list[i], "medium.layers");
    const Value name = one.need("medium");
    const Medium& own = medium_of(name, media, medium);
    MediumLayer& layer = medium.layers.emplace_back();
    layer.medium = own.name;
    layer.coefficients = coefficients_of(own);
    if (i == 0 && !reader.find("specular_ior") && !reader.find("specular_weight")) medium.eta = own.eta;
    if (i == 0 && !reader.find("specular_roughness") && !own.roughness_texture)
      medium.specular_roughness = own.specular_roughness;
    if (const std::string keys = keys_without_effect(own); !keys.empty())
      warnings.push_back(
          text_at(name.place(),
                  fmt::format("'{}': only the scattering and absorption of '{}' count in a layer, not {}",
                              name.path(), own.name, keys)));
    const auto thickness = one.find("thickness");
    const bool is_last = i + 1 == list.size();
    if (is_last && thickness)
      thickness->fail_key("has no effect: the last layer fills the rest", "no thickness");
    if (!is_last) read_thickness(one.need("thickness"), mm_per_unit, layer);
  }
  PhysicalMedium equivalent{};
  for (std::size_t c = 0; c < 3; ++c) {
    const ReducedMedium reduced = equivalent_medium(flat_layers(medium, c), medium.eta);
    if (!(reduced.mean_free_path > 0)) continue;
    equivalent.sigma_a[c] = reduced.absorbed / reduced.mean_free_path;
    equivalent.sigma_s_prime[c] = (1 - reduced.absorbed) / reduced.mean_free_path;
  }
  medium.coefficients = equivalent;
}

}  // namespace opaline
