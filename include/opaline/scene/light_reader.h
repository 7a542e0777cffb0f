// SPDX-License-Identifier: GPL-3.0-or-later
// How the scene file gives each kind of light: its keys and their values. The definitions are in lights/, a
// file a kind.
#pragma once

#include <type_traits>
#include <vector>

#include "opaline/scene/scene.h"
#include "opaline/scene/schema.h"
#include "opaline/scene/value.h"

namespace opaline {

/// Kinds that a camera may see, of those in `lights`: they have the key `visible`.
template <class Kind>
inline constexpr bool kCanBeSeen =
    std::is_same_v<Kind, SphereLight> || std::is_same_v<Kind, QuadLight> ||
    std::is_same_v<Kind, DirectionalLight> || std::is_same_v<Kind, EnvironmentLight>;

template <class Kind>
struct LightReader {
  /// The rows of its section "light.<type>" but for `name` and `visible`, `type` first; none where it is no entry of
  /// `lights`.
  static std::vector<KeyInfo> rows();
  /// in    reader: an object with these keys
  /// error Error{bad_input} at the value
  static Kind read(const ObjectReader& reader, double mm_per_unit);
};

}  // namespace opaline
