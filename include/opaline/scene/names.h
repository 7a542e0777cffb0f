// SPDX-License-Identifier: GPL-3.0-or-later
// The words that scene files, options, reports and metadata use for the enumerations of a scene: one list
// each, in the order of the enumeration.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "opaline/core/error.h"
#include "opaline/scene/scene.h"

namespace opaline {

using NameList = std::span<const std::string_view>;

inline constexpr std::array<std::string_view, 2> kProfileNames{"dipole", "normalized_diffusion"};
inline constexpr std::array<std::string_view, 2> kNormalNames{"smooth", "faceted"};
inline constexpr std::array<std::string_view, 2> kFilterNames{"box", "gaussian"};
inline constexpr std::array<std::string_view, 3> kMethodNames{"hierarchical", "lambert", "direct"};
inline constexpr std::array<std::string_view, 5> kEvaluatorNames{"automatic", "dual_tree", "surface_cache",
                                                                 "classic", "brute_force"};
inline constexpr std::array<std::string_view, 3> kNearIrradianceNames{"mixed", "samples", "point"};
inline constexpr std::array<std::string_view, 4> kInstructionSetNames{"automatic", "baseline", "avx2",
                                                                      "avx512"};
inline constexpr std::array<std::string_view, 2> kEntryStrategyNames{"disc_axes", "chords"};

constexpr NameList names_of(ProfileKind) {
  return kProfileNames;
}
constexpr NameList names_of(NormalMode) {
  return kNormalNames;
}
constexpr NameList names_of(PixelFilter) {
  return kFilterNames;
}
constexpr NameList names_of(Method) {
  return kMethodNames;
}
constexpr NameList names_of(EvaluatorKind) {
  return kEvaluatorNames;
}
constexpr NameList names_of(NearIrradiance) {
  return kNearIrradianceNames;
}
constexpr NameList names_of(InstructionSet) {
  return kInstructionSetNames;
}
constexpr NameList names_of(EntryStrategy) {
  return kEntryStrategyNames;
}

/// The word for a value of one of the enumerations above.
template <class Enumeration>
std::string_view name_of(Enumeration value) {
  const NameList names = names_of(value);
  require(std::size_t(value) < names.size(), "every value of an enumeration has a name");
  return names[std::size_t(value)];
}

inline std::string_view name_of(const LightSource& source) {
  return std::visit([](const auto& light) { return light.kType; }, source);
}

}  // namespace opaline
