// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary of a mesh: transmission of outgoing light, and specular reflection.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "bodies/body.h"
#include "geometry/surface_point.h"
#include "opaline/scene.h"
#include "subsurface/hit_textures.h"
#include "transport/angular_exit.h"
#include "transport/fresnel.h"
#include "transport/outer_boundary.h"
#include "transport/rough_boundary.h"
#include "transport/shared_roughness.h"

namespace opaline {

/// As filtered_alphas, for isotropic facets.
inline float filtered_roughness(float roughness, float slope_variance) {
  if (!(slope_variance > 0)) return roughness;
  const float alpha = roughness * roughness;
  return std::min(1.f, std::sqrt(std::sqrt(alpha * alpha + 2 * slope_variance)));
}

struct Appearance {
  bool translucent = false;
  RgbF albedo{};                       ///< reflectance, or total diffuse reflectance
  float eta = 1;                       ///< eta of the boundary, where there is one
  float average_reflectance = 0;       ///< F_bar
  std::optional<RoughBoundary> rough;  ///< none: smooth
  bool has_boundary = false;           ///< translucent and glossy opaque surfaces
  float metalness = 0;                 ///< metalness of an opaque one
  /// Range of a textured or anisotropic roughness.
  std::shared_ptr<const RoughnessRange> roughnesses = {};
  std::shared_ptr<const AnisotropyRange> anisotropies = {};  ///< for a varying anisotropy
  float roughness = 0;                                       ///< where it is no texture
  const Texture *roughness_texture = nullptr, *metalness_texture = nullptr;
  /// Angular distribution of light traced inside; none: given by the boundary.
  std::shared_ptr<const AngularExit> exit = {};
  OuterBoundary boundary = {};
  RgbF fuzz_color{};  ///< albedo of the fibres
  const Texture* fuzz_color_texture = nullptr;

  /// Looks up the textures of numbers and of fuzz.
  void look_up(const SurfaceTextures::Place& place, const SurfacePoint& point, HitTextures& here) const {
    here.roughness = number_at(roughness_texture, place);
    here.metalness = number_at(metalness_texture, place);
    here.fuzz_color = color_at(fuzz_color_texture, place);
    if (boundary.is_textured()) here.boundary = boundary.at(point);
  }
  bool is_rough() const { return rough || roughnesses || anisotropies; }
  /// Appearance at a point with known textures.
  Appearance at(const HitTextures& textures) const {
    Appearance here = *this;
    here.albedo = albedo * textures.tint.entering * textures.tint.leaving + textures.reflected;
    const float own = textures.roughness.value_or(roughness);
    if (anisotropies) {
      const FacetAlphas alphas =
          filtered_alphas(facet_alphas(std::max(own, RoughnessRange::kLeast), textures.grain.anisotropy),
                          textures.grain.alignment, textures.slope_variance);
      here.rough = anisotropies->at(alphas, textures.tangent_share);
    } else if (roughnesses) {
      here.rough = roughnesses->at(filtered_roughness(own, textures.slope_variance), textures.tangent_share);
    }
    if (textures.metalness) here.metalness = *textures.metalness;
    if (textures.boundary) here.boundary = *textures.boundary;
    if (textures.fuzz_color) here.fuzz_color = *textures.fuzz_color;
    return here;
  }

  /// Specular reflectance for a direction.
  float reflectance(float cosine) const {
    return rough ? rough->reflectance(cosine) : fresnel_reflectance(cosine, eta);
  }
  /// Outgoing radiance over radiant exitance. Adds up to 1 with the specular reflectance in a white furnace.
  float radiance_of_exitance(float cosine) const {
    constexpr float kInversePi = std::numbers::inv_pi_v<float>;
    if (!has_boundary) return kInversePi;
    const float entered = kInversePi * (1 - reflectance(cosine)) / (1 - average_reflectance);
    return metalness > 0 ? entered * (1 - metalness) : entered;
  }
  /// radiance_of_exitance past fuzz. Fibres also send light back to the surface, where it is reflected again,
  /// here diffusely: a white surface with white fibres stays white in a white furnace.
  RgbF radiance_past_fuzz(float cosine) const {
    constexpr float kMostMirrored = 2;  // light leaving thin parts of a dark body may not have entered there
    const float once = radiance_of_exitance(cosine), entering = has_boundary ? 1 - average_reflectance : 1;
    const RgbF mirrored =
        has_boundary ? RgbF(average_reflectance * (1 - metalness)) + albedo * metalness : RgbF(0);
    RgbF radiance;
    for (std::size_t c = 0; c < 3; ++c) {
      const float entered = entering * albedo[c],
                  reflected = std::min(1.f, mirrored[c] + entered * (1 - metalness)),
                  again = (1 - boundary.past_fuzz()) * fuzz_color[c] * reflected;
      const float all = translucent ? std::min(reflected, kMostMirrored * entered) : reflected;
      radiance[c] =
          once + std::numbers::inv_pi_v<float> * all / std::max(entered, 1e-6f) * again / (1 - again);
    }
    return radiance * boundary.past_fuzz(cosine);
  }
  /// Light scattered back by fuzz under uniform illumination.
  RgbF fuzz_share(float cosine) const { return fuzz_color * (1 - boundary.past_fuzz(cosine)); }

  bool mirrors() const { return has_boundary && eta != 1; }
  /// Specular reflectance of uniform illumination, by view direction.
  RgbF mirrored_share(float cosine) const {
    const float dielectric = reflectance(cosine);
    if (!(metalness > 0)) return RgbF(dielectric);
    const float once = rough ? rough->reflected_once(cosine) : 1;
    return RgbF(dielectric * (1 - metalness)) +
           metal(cosine) * (RgbF(once) + albedo * (1 - once)) * metalness;
  }
  /// Specular reflectance over that of a dielectric boundary; above the single-scattering value, as facets
  /// reflect repeatedly.
  /// in    cosine: between the direction and the facet's normal; reflected_once: RoughBoundary's, for the
  ///       view
  /// from  Turquin 2019, Practical multiple scattering compensation for microfacet models
  RgbF mirror_color(float cosine, float reflected_once = 1) const {
    if (!(metalness > 0)) return RgbF(1);
    const float dielectric = fresnel_reflectance(std::min(cosine, 1.0f), eta);
    const RgbF again = RgbF(1) + albedo * (1 / reflected_once - 1);
    return RgbF(1 - metalness) + metal(cosine) * again * (metalness / dielectric);
  }
  /// Reflectance of a metal's facet.
  /// from  Schlick 1994
  RgbF metal(float cosine) const {
    const float grazing = std::pow(1 - std::min(cosine, 1.0f), 5.0f);
    return albedo + (RgbF(1) - albedo) * grazing;
  }
};

/// in    has_normals: a map whose slopes within a pixel add to the roughness
inline void roughen(Appearance& appearance, double roughness, const std::optional<Texture>& texture,
                    const Grain& grain, double eta, bool has_normals) {
  const float anisotropy = float(grain.anisotropy);
  appearance.roughness = float(roughness);
  appearance.roughness_texture = pointer_to(texture);
  const bool is_rough = texture || roughness > 0, is_anisotropic = anisotropy > 0 || grain.anisotropy_texture;
  if (is_rough && is_anisotropic && (grain.anisotropy_texture || grain.cosine_texture || has_normals))
    appearance.anisotropies = shared_anisotropies(eta);
  else if (texture || (has_normals && roughness > 0))
    appearance.roughnesses = shared_roughness(eta, anisotropy);
  else if (roughness > 0 && anisotropy > 0)
    appearance.roughnesses = shared_roughness(eta, anisotropy, appearance.roughness);
  else if (roughness > 0)
    appearance.rough.emplace(roughness, eta);
}

/// True with a normal map, or an image of heights.
inline bool has_slopes(const Shape& shape) {
  return shape.normal_map || (shape.bump_map && !is_solid(*shape.bump_map));
}

inline void set_fuzz(Appearance& appearance, const Fuzz& fuzz, const OuterBoundary& boundary) {
  appearance.boundary = boundary;
  appearance.fuzz_color = RgbF(fuzz.color);
  appearance.fuzz_color_texture = pointer_to(fuzz.color_texture);
}

inline Appearance opaque_appearance(const Shape& shape, const OuterBoundary& boundary) {
  Appearance appearance{.albedo = RgbF(shape.reflectance), .rough = {}};
  set_fuzz(appearance, shape.fuzz, boundary);
  if (!shape.gloss) return appearance;
  const Gloss& gloss = *shape.gloss;
  appearance.eta = float(gloss.eta);
  appearance.average_reflectance = float(average_reflectance_outside(gloss.eta));
  appearance.has_boundary = true;
  appearance.metalness = float(gloss.metalness);
  appearance.metalness_texture = pointer_to(gloss.metalness_texture);
  roughen(appearance, gloss.roughness, gloss.roughness_texture, gloss.grain, gloss.eta, has_slopes(shape));
  return appearance;
}

/// follows_light: true if the method traces light inside, and its radiance has the angular distribution of a
/// half space
inline Appearance mesh_appearance(const Scene& scene, const Shape& shape, const OuterBoundary& boundary,
                                  bool follows_light) {
  if (!shape.medium) return opaque_appearance(shape, boundary);
  const Medium& medium = scene.media[*shape.medium];
  const DiffuseProfile profile = make_diffuse_profile(medium);
  Appearance appearance{true, RgbF(profile.total), float(profile.eta), float(profile.average_reflectance), {},
                        true};
  set_fuzz(appearance, medium.fuzz, boundary);
  roughen(appearance, medium.specular_roughness, medium.roughness_texture, medium.grain, medium.eta,
          has_slopes(shape));
  if (follows_light)
    appearance.exit = std::make_shared<const AngularExit>(reduced_absorption(medium), medium.eta);
  return appearance;
}

/// Cosine of the view direction with the shading normal, at least half of its cosine with the geometric
/// normal. On coarse meshes a shading normal may face away from a camera facing the triangle, and the
/// boundary would then transmit nothing.
inline float cos_view(const SurfacePoint& point, const Vec3f& direction) {
  const float side = dot(point.geometric, direction), shading = dot(point.normal, direction);
  const float towards = side > 0 ? shading : -shading;
  return std::min(1.0f, std::max(towards, 0.5f * std::abs(side)) / length(direction));
}

}  // namespace opaline
