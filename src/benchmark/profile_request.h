// SPDX-License-Identifier: GPL-3.0-or-later
// The medium of `opaline profile`, by its name, its coefficients, or from a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "benchmark/profile_report.h"

namespace opaline {

struct GivenProfile {
  std::string medium;                     ///< preset name, or a JSON object as in a scene's media
  std::string scene;                      ///< file with the medium by its name; empty: none
  std::optional<std::string> scene_text;  ///< contents of that file; none: read from the disk
  std::optional<double> eta, g;           ///< replace the medium's
  std::optional<double> thickness;        ///< mm; none: a half space
  std::optional<std::uint64_t> walks;
  std::uint64_t seed = 1;
  std::vector<std::string> profiles;  ///< names of radial profiles; none: all
  const char* prefix = "--";          ///< before option names in messages
};

/// error Error{bad_input}: no such medium, a value out of its range, a medium without coefficients
ProfileRequest profile_request(const GivenProfile& given);

}  // namespace opaline
