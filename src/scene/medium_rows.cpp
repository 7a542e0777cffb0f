// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/scene/names.h"
#include "scene/key_rows.h"
#include "scene/presets.h"

namespace opaline {
namespace {

std::string_view profile_meaning() {
  static const std::string text = [] {
    std::string list = "how light spreads under the surface: `\"auto\"` (chosen for each body, see the plan)";
    for (std::size_t i = 0; i < kProfileNames.size(); ++i)
      list += ", `\"" + std::string(kProfileNames[i]) + "\"` (" + std::string(kProfileSources[i]) + ')';
    return list;
  }();
  return text;
}

}  // namespace

std::vector<KeyInfo> medium_rows() {
  using enum ValueType;
  return {
      row("medium", "preset", choice, "", kFiniteNumber, "",
          "a measured material: apple, chicken1, chicken2, cream, ketchup, marble, potato, skimmilk, skin1, "
          "skin2, spectralon, wholemilk (Jensen et al. 2001)",
          preset_names()),
      row("medium", "sigma_a", number_or_triple, "1/mm", kNonNegative, "", "absorption"),
      row("medium", "sigma_s_prime", number_or_triple, "1/mm", kNonNegative, "",
          "reduced scattering, (1 - g) sigma_s"),
      row("medium", "sigma_s", number_or_triple, "1/mm", kNonNegative, "", "scattering"),
      row("medium", "g", number, "", {-1, 1, true, true}, "0",
          "mean cosine of the scattering angle, beside `sigma_s`: 0 even, towards 1 forward, towards -1 "
          "back"),
      textured(row(
          "medium", "subsurface_color", color, "", kUnitInterval, "",
          "how much of the light that enters comes out again; of a texture the mean, and each texel over it "
          "the `tint`, but for `texture_mix` `\"medium\"`")),
      textured(row("medium", "subsurface_radius", number_or_triple, "mm", kNonNegative, "",
                   "how far light goes before it is scattered or absorbed, 1/sigma_t; three numbers are red, "
                   "green and blue, not x, y, z; a texture's numbers times its `scale`: `volume_diffusion` "
                   "and `volume` follow it inside, other methods take its mean")),
      row("medium", "subsurface_radius_scale", number_or_triple, "", kNonNegative, "1",
          "multiplies `subsurface_radius`, for a tint"),
      row("medium", "subsurface_scatter_anisotropy", number, "", {-1, 1, true, true}, "0",
          "the same as `g`, beside `subsurface_color`"),
      row("medium", "scatter_anisotropy", number, "", {-.95, .95}, "0",
          "the same for `volume` alone, beside `preset` or `sigma_s_prime`: sigma_s is sigma_s_prime / (1 - "
          "g); "
          "diffusion depends on `sigma_s_prime` only"),
      row("medium", "specular_ior", number, "", {.1, 10},
          "the preset's (marble 1.5, all others 1.3), else 1.3", "index of refraction, inside over outside"),
      textured(row(
          "medium", "specular_roughness", number, "", kUnitInterval, "0",
          "of the surface as it mirrors: 0 smooth, .3 satin; alone a rough one shows highlights of lights "
          "without size")),
      row("medium", "specular_weight", number, "", {0, 1}, "1",
          "times what the surface mirrors at right angles: an index of refraction of its own, for light from "
          "inside as well; at 0 all light enters"),
      row("medium", "specular_anisotropy", number, "", kUnitInterval, "0", kAnisotropyMeaning),
      row("medium", "specular_rotation", number, "degrees", {-360, 360}, "0", kRotationMeaning),
      textured(row("medium", "subsurface_weight", number, "", kUnitInterval, "1",
                   "share of the light that scatters below the surface; the rest is reflected there by "
                   "`base_color`; a texture is met as `texture_mix` says")),
      textured(row("medium", "base_color", color, "", kUnitInterval, "0.8",
                   "what reflects that rest, diffusely, beside a `subsurface_weight`")),
      textured(row(
          "medium", "tint", color, "", kUnitInterval, "1",
          "colours the light of any medium at its surface, by `texture_mix`; where it is even, what leaves "
          "is times the tint")),
      row("medium", "texture_mix", choice, "", kFiniteNumber, "`\"split\"`",
          "where the tint is met: `\"pre\"` by light that enters, and blurred like it; `\"post\"` by light "
          "that "
          "leaves, sharp; `\"split\"` its root by both; `\"medium\"`: a texture of `subsurface_color` is the "
          "medium's, at each place inside that of the nearest place of the surface, by `volume_diffusion` "
          "and `volume`; other methods take `\"split\"`",
          kTextureMixNames),
      row("medium", "thickness", length, "", kFiniteNumber,
          "`\"auto\"`: that of flat bodies; else that of the built-in plates, else thick",
          "for `\"multipole\"`, which takes the place of `\"auto\"` then: how thick the things made of it "
          "are; light that enters on the far side "
          "leaves on "
          "this one"),
      row("medium", "profile", choice, "", kFiniteNumber, "`\"auto\"`", profile_meaning(), kProfileChoices),
      row("medium", "fit", choice, "", kFiniteNumber, "`\"refit\"`",
          "length of `\"normalized_diffusion\"`, which replaces `\"auto\"` then: `\"refit\"`, fitted to "
          "random "
          "walks behind a boundary; of Christensen & Burley 2015 without a boundary `\"diffuse_entry\"`, "
          "`\"searchlight\"` (a beam) and `\"dmfp\"` (by the diffuse mean free path)",
          kFitNames),
  };
}

}  // namespace opaline
