// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/key_rows.h"
#include "input/presets.h"
#include "input/readers.h"

namespace opaline {
namespace {

std::string_view profile_meaning() {
  static const std::string text = [] {
    std::string list = "radial profile of the BSSRDF: `\"auto\"` (chosen per body, see the plan)";
    for (std::size_t i = 0; i < kProfileNames.size(); ++i)
      list += ", `\"" + std::string(kProfileNames[i]) + "\"` (" + std::string(kProfileSources[i]) + ')';
    return list;
  }();
  return text;
}

/// Row of a number or texture, with its two members.
template <auto kValue, auto kTexture>
MediumRow textured(KeyInfo info) {
  return {textured(std::move(info)),
          [](Medium& medium, const Value& value) { read_textured(value, medium.*kValue, medium.*kTexture); }};
}

}  // namespace

std::vector<KeyInfo> fuzz_rows(std::string_view section) {
  using enum ValueType;
  return {
      textured(row(section, "fuzz_weight", number, "", kUnitInterval, "0",
                   "fraction of the surface with fibres, as in OpenPBR: peach fuzz, velvet, dust")),
      textured(row(section, "fuzz_color", color, "", kUnitInterval, "1", "albedo of the fibres")),
      textured(row(section, "fuzz_roughness", number, "", kUnitInterval, "0.5",
                   "1: fibres in all directions; towards 0: along the normal, with light at grazing angles "
                   "only; below 0.25 as 0.25"))};
}

std::span<const MediumRow> medium_rows() {
  using enum ValueType;
  static const std::vector<KeyInfo> fuzz = fuzz_rows("medium");
  static const std::vector<MediumRow> table{
      row("medium", "preset", choice, "", kFiniteNumber, "",
          "a measured material: apple, chicken1, chicken2, cream, ketchup, marble, potato, skimmilk, skin1, "
          "skin2, spectralon, wholemilk (Jensen et al. 2001); or a look, by eye: alabaster, candle, grape, "
          "honey, "
          "jade, leaf, milk_glass, salmon, skin_dark, skin_fair, snow, soap, wax",
          preset_names()),
      row("medium", "sigma_a", number_or_triple, "1/mm", kNonNegative, "", "absorption"),
      row("medium", "sigma_s_prime", number_or_triple, "1/mm", kNonNegative, "",
          "reduced scattering, (1 - g) sigma_s"),
      row("medium", "sigma_s", number_or_triple, "1/mm", kNonNegative, "", "scattering"),
      row("medium", "g", number, "", {-1, 1, true, true}, "0",
          "mean cosine of the scattering angle, with `sigma_s`: 0 isotropic, above 0 forward, below 0 "
          "backward"),
      textured(row("medium", "subsurface_color", color, "", kUnitInterval, "",
                   "multiple-scattering albedo: diffuse reflectance of transmitted light. A texture defines "
                   "the medium by its mean, and `tint` by each texel over the mean, unless `texture_mix` is "
                   "`\"medium\"`")),
      textured(row("medium", "subsurface_radius", number_or_triple, "mm", kNonNegative, "",
                   "mean free path 1/sigma_t; three numbers are red, green and blue, not x, y, z. Texels are "
                   "multiplied by `scale`: `volume_diffusion` and `volume` vary the medium inside, other "
                   "methods use the mean")),
      row("medium", "subsurface_radius_scale", number_or_triple, "", kNonNegative, "1",
          "factor of `subsurface_radius`"),
      row("medium", "subsurface_scatter_anisotropy", number, "", {-1, 1, true, true}, "0",
          "the same as `g`, with `subsurface_color`"),
      row("medium", "layers", list, "", kFiniteNumber, "",
          "layers of other media below the surface, from the surface inwards; the last one fills the rest. "
          "`volume_diffusion` and `volume` have them by the depth below the nearest surface point; "
          "`hierarchical` and `direct` by random walks through the stack (the profile `tabulated`, their "
          "default with layers); other methods use a homogeneous medium of the same reflectance and width of "
          "scattering"),
      row("medium.layers", "medium", text, "", kFiniteNumber, "",
          "name of a homogeneous medium; its index of refraction is that of the layered medium"),
      textured(
          row("medium.layers", "thickness", number, "scene units", kNonNegative, "",
              "thickness, of all layers but the last one; a texture's texels are multiplied by `scale`")),
      row("medium", "scatter_anisotropy", number, "", {-.95, .95}, "0",
          "the same for `volume` only, with `preset` or `sigma_s_prime`: sigma_s is sigma_s_prime / (1 - g); "
          "diffusion depends on `sigma_s_prime` only"),
      row("medium", "specular_ior", number, "", {.1, 10},
          "the preset's (of measured ones 1.3, marble 1.5), the first layer's, else 1.3",
          "index of refraction, inside over outside"),
      textured<&Medium::specular_roughness, &Medium::roughness_texture>(row(
          "medium", "specular_roughness", number, "", kUnitInterval, "the look's, the first layer's, else 0",
          "roughness of the specular reflection: 0 smooth, 0.3 satin; only a rough surface shows "
          "highlights of point, spot and directional lights")),
      row("medium", "specular_weight", number, "", {0, 1}, "1",
          "factor of the specular reflectance at normal incidence, through a modified index of refraction, "
          "also for light from inside; at 0 all light enters"),
      textured(row("medium", "specular_anisotropy", number, "", kUnitInterval, "0", kAnisotropyMeaning)),
      textured(row("medium", "specular_rotation", number, "degrees", {-360, 360}, "0", kRotationMeaning)),
      fuzz[0],
      fuzz[1],
      fuzz[2],
      textured<&Medium::subsurface_weight, &Medium::weight_texture>(
          row("medium", "subsurface_weight", number, "", kUnitInterval, "1",
              "fraction of the light that scatters below the surface; `base_color` reflects the rest; "
              "`texture_mix` applies to a texture")),
      textured<&Medium::base_color, &Medium::base_texture>(
          row("medium", "base_color", color, "", kUnitInterval, "0.8",
              "diffuse reflectance for the rest of the light, with `subsurface_weight`")),
      textured<&Medium::tint, &Medium::tint_texture>(
          row("medium", "tint", color, "", kUnitInterval, "1",
              "colours the light at the surface of any medium, by `texture_mix`; a constant tint "
              "multiplies the exitance")),
      row("medium", "texture_mix", choice, "", kFiniteNumber, "`\"split\"`",
          "application of the tint: `\"pre\"`: to transmitted irradiance, blurred by scattering; `\"post\"`: "
          "to exitance, sharp; `\"split\"`: its square root to both; `\"medium\"`: a texture of "
          "`subsurface_color` varies the medium; each point inside has the medium of the nearest surface "
          "point, in `volume_diffusion` and `volume`; other methods use `\"split\"`",
          kTextureMixNames),
      row("medium", "thickness", length, "", kFiniteNumber,
          "with the profile `\"auto\"`: thickness of flat bodies; otherwise that of the built-in plates, "
          "else infinite",
          "thickness of the shapes, for `\"multipole\"`; if set, this profile replaces `\"auto\"`; transmits "
          "light between the two sides"),
      row("medium", "profile", choice, "", kFiniteNumber, "`\"auto\"`", profile_meaning(), kProfileChoices),
      row("medium", "fit", choice, "", kFiniteNumber, "`\"refit\"`",
          "length scale of `\"normalized_diffusion\"`; if set, this profile replaces `\"auto\"`: "
          "`\"refit\"`: fitted to random walks with a boundary; without a boundary (Christensen & Burley "
          "2015): `\"diffuse_entry\"`, `\"searchlight\"` (a beam) and `\"dmfp\"` (from the diffuse mean free "
          "path)",
          kFitNames),
  };
  return table;
}

}  // namespace opaline
