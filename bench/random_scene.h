// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of a few random bodies, media, lights and settings, for what must hold of any scene.
#pragma once

#include <cstdint>
#include <string>

namespace opaline {

/// Names of the methods that bench_plan compares.
inline constexpr const char* kPlannedMethods[] = {"hierarchical", "volume_diffusion", "volume", "direct",
                                                  "lambert"};

/// The text of a scene file; the same for the same number.
std::string random_scene(std::uint64_t number, const std::string& method);

}  // namespace opaline
