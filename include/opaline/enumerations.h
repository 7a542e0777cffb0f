// SPDX-License-Identifier: GPL-3.0-or-later
// Enumerations of a scene, with the names used by scene files, options, reports and metadata in the order of
// each enumeration: names_of(value).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace opaline {

using NameList = std::span<const std::string_view>;

/// Radial diffuse reflectance profile R_d(r) of a medium; in the order of ChannelProfile after its monostate (diffuse_profile.h).
enum class ProfileKind {
  dipole,
  normalized_diffusion,  ///< its length by NormalizedDiffusionFit
  better_dipole,
  tabulated,          ///< random walks through the medium itself
  multipole,          ///< a plate of the medium's thickness
  directional_dipole  ///< depends on the direction of entry; method `direct` only
};
inline constexpr std::array<std::string_view, 6> kProfileNames{
    "dipole", "normalized_diffusion", "better_dipole", "tabulated", "multipole", "directional_dipole"};
inline constexpr std::array<std::string_view, 6> kProfileSources{
    "Jensen et al. 2001",         "Christensen & Burley 2015", "d'Eon 2012",
    "random walks of the medium", "Donner & Jensen 2005",      "Frisvad et al. 2014"};
/// Values of `profile` of a medium: automatic, or one of the profiles.
inline constexpr std::array<std::string_view, kProfileNames.size() + 1> kProfileChoices = [] {
  std::array<std::string_view, kProfileNames.size() + 1> choices{"auto"};
  for (std::size_t i = 0; i < kProfileNames.size(); ++i) choices[i + 1] = kProfileNames[i];
  return choices;
}();
constexpr NameList names_of(ProfileKind) {
  return kProfileNames;
}

/// Fit of the length d of normalized diffusion.
enum class NormalizedDiffusionFit {
  diffuse_entry,  ///< Christensen & Burley 2015, diffuse entry without a boundary
  searchlight,    ///< Christensen & Burley 2015, a beam along the normal without a boundary
  dmfp,           ///< Christensen & Burley 2015, by the diffuse mean free path
  refit           ///< random walks behind a boundary in diffuse light
};
inline constexpr std::array<std::string_view, 4> kFitNames{"diffuse_entry", "searchlight", "dmfp", "refit"};
constexpr NameList names_of(NormalizedDiffusionFit) {
  return kFitNames;
}

enum class NormalMode {
  smooth,   ///< angle-weighted average at each vertex, or the file's own normals if present
  faceted,  ///< geometric normals
};
inline constexpr std::array<std::string_view, 2> kNormalNames{"smooth", "faceted"};
constexpr NameList names_of(NormalMode) {
  return kNormalNames;
}

enum class PixelFilter { box, gaussian };
inline constexpr std::array<std::string_view, 2> kFilterNames{"box", "gaussian"};
constexpr NameList names_of(PixelFilter) {
  return kFilterNames;
}

enum class Method {
  hierarchical,      ///< diffusion from the tree of samples
  lambert,           ///< diffuse reflection on translucent surfaces: the cheapest method
  direct,            ///< importance sampling of the BSSRDF: the noisy reference of `hierarchical`
  volume,            ///< random walks inside the bodies: the reference without a model, noisy
  volume_diffusion,  ///< the diffusion equation inside the bodies: no kernel, no noise
  automatic,         ///< volume_diffusion or hierarchical, whichever suits a body
  preintegrated,     ///< diffusion in a ball of the local curvature: for moving objects, without a precompute
  image_space        ///< `hierarchical` with samples seen from the lights: for moving objects
};
inline constexpr std::array<std::string_view, 8> kMethodNames{"hierarchical",  "lambert",          "direct",
                                                              "volume",        "volume_diffusion", "auto",
                                                              "preintegrated", "image_space"};
constexpr NameList names_of(Method) {
  return kMethodNames;
}

enum class EvaluatorKind {
  automatic,      ///< surface_cache if the image has many more points than the cache, else dual_tree
  dual_tree,      ///< clusters of points against nodes, to a tolerance
  surface_cache,  ///< dual_tree at points over the surface, interpolated for each hit
  classic,        ///< each point traverses the tree, as published
  brute_force     ///< every sample
};
inline constexpr std::array<std::string_view, 5> kEvaluatorNames{"automatic", "dual_tree", "surface_cache",
                                                                 "classic", "brute_force"};
constexpr NameList names_of(EvaluatorKind) {
  return kEvaluatorNames;
}

/// Source of the near field's irradiance; mixed: weights keeping the kernel's width.
enum class NearIrradiance { mixed, samples, point };
inline constexpr std::array<std::string_view, 3> kNearIrradianceNames{"mixed", "samples", "point"};
constexpr NameList names_of(NearIrradiance) {
  return kNearIrradianceNames;
}

/// Instruction set of the dual tree's inner loops; automatic: the widest of the processor.
enum class InstructionSet { automatic, baseline, avx2, avx512 };
inline constexpr std::array<std::string_view, 4> kInstructionSetNames{"automatic", "baseline", "avx2",
                                                                      "avx512"};
constexpr NameList names_of(InstructionSet) {
  return kInstructionSetNames;
}

/// Encoding of an image file's numbers.
enum class ColorSpace {
  automatic,  ///< sRGB for colours in integer files, otherwise linear
  srgb,
  linear
};
inline constexpr std::array<std::string_view, 3> kColorSpaceNames{"automatic", "srgb", "linear"};
constexpr NameList names_of(ColorSpace) {
  return kColorSpaceNames;
}

/// Tone mapping of linear light with white at 1 for PNGs (view_transform.h).
enum class ViewTransform {
  soft,     ///< unchanged below 0.8, compressed above
  neutral,  ///< Khronos PBR Neutral
  agx,      ///< AgX with its default contrast, approximated
  srgb      ///< clipped at white
};
inline constexpr std::array<std::string_view, 4> kViewNames{"soft", "neutral", "agx", "srgb"};
constexpr NameList names_of(ViewTransform) {
  return kViewNames;
}

/// Colour space of an EXR; names as in OpenColorIO configurations.
enum class FilmColorSpace { lin_rec709, acescg };
inline constexpr std::array<std::string_view, 2> kFilmColorSpaceNames{"lin_rec709", "acescg"};
constexpr NameList names_of(FilmColorSpace) {
  return kFilmColorSpaceNames;
}

/// Position of a translucent body's tint t: on entry (pre), on exit (post), or its root on both. With
/// `medium`, a texture of the medium's colour varies the medium itself instead.
enum class TextureMix { pre, post, split, medium };
inline constexpr std::array<std::string_view, 4> kTextureMixNames{"pre", "post", "split", "medium"};
constexpr NameList names_of(TextureMix) {
  return kTextureMixNames;
}

/// Combination of a detail with the colour below: a factor, relative to its mean, or an overlay.
enum class DetailBlend { relative, overlay };
inline constexpr std::array<std::string_view, 2> kDetailBlendNames{"relative", "overlay"};
constexpr NameList names_of(DetailBlend) {
  return kDetailBlendNames;
}

enum class EntryStrategy { disc_axes, chords };
inline constexpr std::array<std::string_view, 2> kEntryStrategyNames{"disc_axes", "chords"};
constexpr NameList names_of(EntryStrategy) {
  return kEntryStrategyNames;
}

}  // namespace opaline
