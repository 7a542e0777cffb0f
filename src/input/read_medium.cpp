// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/texture_file.h"
#include "input/key_rows.h"
#include "input/presets.h"
#include "input/readers.h"
#include "input/spectral_values.h"
#include "scene/scene_properties.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

/// One way to define a medium: its decisive key, and the accompanying keys.
struct Form {
  std::string_view decisive;
  std::vector<std::string_view> companions;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> table{
      {"preset", {"scatter_anisotropy"}},
      {"sigma_s_prime", {"sigma_a", "scatter_anisotropy"}},
      {"sigma_s", {"sigma_a", "g"}},
      {"layers", {}},
      {"subsurface_color", {"subsurface_radius", "subsurface_radius_scale", "subsurface_scatter_anisotropy"}},
  };
  return table;
}

/// Decisive key of the medium's form. error if there is none, several, or a key of another form beside it
std::string_view form_of(const ObjectReader& medium) {
  const std::string ways =
      "preset, sigma_a + sigma_s_prime, sigma_a + sigma_s (+ g), subsurface_color + subsurface_radius, or "
      "layers";
  const Form* form = nullptr;
  for (const Node& member : medium.node().children)
    for (const Form& f : forms()) {
      if (member.key != f.decisive) continue;
      if (form != nullptr)
        medium.need(member.key)
            .fail_key("cannot be combined with '" + std::string(form->decisive) + "'", ways);
      form = &f;
    }
  if (form == nullptr) medium.fail("does not define the medium", ways);
  for (const Form& other : forms())
    for (const std::string_view key : other.companions)
      if (std::find(form->companions.begin(), form->companions.end(), key) == form->companions.end())
        if (const std::optional<Value> value = medium.find(key))
          value->fail_key("has no effect with '" + std::string(form->decisive) + "'", ways);
  return form->decisive;
}

const Preset& preset_of(const Value& value) {
  return presets()[value.choice()];
}

PhysicalMedium read_physical(const ObjectReader& medium) {
  PhysicalMedium result;
  result.sigma_a = medium.need("sigma_a").number_or_triple();
  if (const auto sigma_s_prime = medium.find("sigma_s_prime")) {
    result.sigma_s_prime = sigma_s_prime->number_or_triple();
    return result;
  }
  const auto g = medium.find("g");
  result.sigma_s_prime = medium.need("sigma_s").number_or_triple() * (1 - (g ? g->number() : 0));
  return result;
}

/// Uses the mean colour of a texture for the medium, and the relative texels as a tint.
void take_color(const Value& value, ArtistMedium& coefficients, Medium& medium) {
  read_textured(value, coefficients.subsurface_color, medium.tint_texture);
  if (!medium.tint_texture) return;
  const Rgb mean = take_mean(*medium.tint_texture);
  for (std::size_t c = 0; c < 3; ++c) coefficients.subsurface_color[c] = std::min(mean[c], 1.0);
}

void take_radius(const Value& value, ArtistMedium& coefficients, Medium& medium) {
  read_textured(value, coefficients.subsurface_radius, medium.radius_texture);
  if (medium.radius_texture) coefficients.subsurface_radius = take_mean(*medium.radius_texture);
}

ArtistMedium read_artist(const ObjectReader& medium, Medium& owner) {
  ArtistMedium result;
  take_color(medium.need("subsurface_color"), result, owner);
  take_radius(medium.need("subsurface_radius"), result, owner);
  if (const auto scale = medium.find("subsurface_radius_scale"))
    result.subsurface_radius = result.subsurface_radius * scale->number_or_triple();
  if (const auto g = medium.find("subsurface_scatter_anisotropy")) result.anisotropy = g->number();
  return result;
}

void read_textured_values(const ObjectReader& reader, Medium& medium) {
  const auto mix = reader.find("texture_mix"), tint = reader.find("tint"), base = reader.find("base_color");
  if (mix) medium.texture_mix = static_cast<TextureMix>(mix->choice());
  if (tint && medium.texture_mix == TextureMix::medium)
    mix->fail("applies to 'subsurface_color' only", "another value with 'tint'");
  if (tint && medium.tint_texture)
    tint->fail_key("cannot be combined with a texture of 'subsurface_color'", "one of the two");
  if (base && !reader.find("subsurface_weight"))
    base->fail_key("has no effect without a 'subsurface_weight' below 1", "'subsurface_weight' with it");
  for (const MediumRow& row : medium_rows())
    if (row.read != nullptr)
      if (const auto value = reader.find(row.info.key)) row.read(medium, *value);
  if (!is_partly_opaque(medium)) medium.base_texture.reset();  // unused, as its colour
}

}  // namespace

std::vector<std::string> keys_without_effect(const Value& value, const Medium& medium) {
  const ObjectReader reader(value, "medium");
  std::vector<std::string> warnings;
  const auto check = [&](const char* key, ProfileKind user) {
    const auto unused = reader.find(key);
    if (!unused || medium.profile == user) return;
    warnings.push_back(
        text_at(unused->place(),
                fmt::format("'{}' has no effect with the profile '{}'; it applies to '{}'", unused->path(),
                            kProfileNames[std::size_t(*medium.profile)], kProfileNames[std::size_t(user)])));
  };
  check("thickness", ProfileKind::multipole);
  check("fit", ProfileKind::normalized_diffusion);
  return warnings;
}

double weighted_ior(double ior, double weight) {
  if (weight == 1) return ior;
  const double amplitude = (ior - 1) / (ior + 1) * std::sqrt(weight);
  return (1 + amplitude) / (1 - amplitude);
}

Grain read_grain(const ObjectReader& reader) {
  Grain grain;
  if (const auto anisotropy = reader.find("specular_anisotropy"))
    read_textured(*anisotropy, grain.anisotropy, grain.anisotropy_texture);
  if (const auto rotation = reader.find("specular_rotation")) read_rotation(*rotation, grain);
  return grain;
}

Fuzz read_fuzz(const ObjectReader& reader) {
  Fuzz fuzz;
  const auto weight = reader.find("fuzz_weight"), color = reader.find("fuzz_color"),
             roughness = reader.find("fuzz_roughness");
  for (const auto& key : {color, roughness})
    if (key && !weight) key->fail_key("has no effect without fibres", "'fuzz_weight' with it");
  if (weight) read_textured(*weight, fuzz.weight, fuzz.weight_texture);
  if (color) read_textured(*color, fuzz.color, fuzz.color_texture);
  if (roughness) read_textured(*roughness, fuzz.roughness, fuzz.roughness_texture);
  return fuzz;
}

Medium read_medium(const Value& value, double mm_per_unit) {
  const ObjectReader reader(value, "medium");
  Medium medium;
  medium.name = value.node().key;
  medium.place = value.place();
  if (medium.name.empty()) value.fail_key("has no name", "a nonempty name");
  const std::string_view form = form_of(reader);
  if (form == "preset") {
    const Value name = reader.need("preset");
    const Preset& preset = preset_of(name);
    medium.coefficients =
        PhysicalMedium{coefficients_at(preset.coefficients.sigma_a, reader.wavelengths()),
                       coefficients_at(preset.coefficients.sigma_s_prime, reader.wavelengths())};
    medium.eta = preset.eta;
    medium.specular_roughness = preset.roughness;
  } else if (form == "layers") {
    medium.coefficients = PhysicalMedium{};
    medium.layers.emplace_back();  // replaced by read_layers
  } else if (form == "subsurface_color") {
    medium.coefficients = read_artist(reader, medium);
  } else {
    medium.coefficients = read_physical(reader);
  }
  if (const auto g = reader.find(form == "sigma_s" ? "g" : "scatter_anisotropy"))
    medium.scatter_anisotropy = g->number();
  if (const auto ior = reader.find("specular_ior")) medium.eta = ior->number();
  if (const auto weight = reader.find("specular_weight"))
    medium.eta = weighted_ior(medium.eta, weight->number());
  medium.grain = read_grain(reader);
  medium.fuzz = read_fuzz(reader);
  read_textured_values(reader, medium);
  const auto profile = reader.find("profile");
  const std::size_t choice = profile ? profile->choice() : 0;
  medium.profile.reset();
  if (choice > 0) medium.profile = static_cast<ProfileKind>(choice - 1);
  const auto thickness = reader.find("thickness");
  if (thickness) medium.thickness = thickness->length(mm_per_unit);
  if (thickness && choice == 0) medium.profile = ProfileKind::multipole;
  if (const auto fit = reader.find("fit")) {
    medium.fit = NormalizedDiffusionFit(fit->choice());
    if (thickness && choice == 0)
      fit->fail_key("cannot be combined with 'thickness'", "a 'profile' with them");
    if (choice == 0) medium.profile = ProfileKind::normalized_diffusion;
  }
  return medium;
}

}  // namespace opaline
