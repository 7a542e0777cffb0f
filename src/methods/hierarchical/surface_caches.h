// SPDX-License-Identifier: GPL-3.0-or-later
// Choice of bodies with a surface cache.
#pragma once

#include <optional>
#include <vector>

#include "bodies/body.h"
#include "exitance/surface_cache.h"

namespace opaline {

/// The most places of a group's surface cache where the settings ask for one, and the memory that a place may
/// take while the cache is made, bytes (measured). A surface that takes more, such as needles cut into
/// squares of the near field's size, is evaluated at the points of the picture.
std::size_t most_wanted_places(const GroupPlan& group, const World& world);
inline constexpr std::size_t kBytesOfPlace = 250;
/// The places that such a cache is expected to have, at most most_wanted_places.
std::size_t expected_cache_places(const GroupPlan& group, const World& world);

/// For each group of the plan the most places that a surface cache may have: most_wanted_places if the
/// settings ask for one, 0 if they ask for another evaluator; if they leave it open a part of the points at
/// which the camera sees the group, times the pictures. A crop counts as the whole picture, whose bytes it
/// shares. 0 where a tint colours light entering: a cache does not know its details.
std::vector<std::size_t> most_cache_places(const PrecomputeInput& input, std::span<const Body> groups,
                                           std::size_t pictures = 1);

/// True if make_body_cache would make this cache.
bool may_use(const SurfaceCache& cache, const PrecomputeInput& input, const Body& group,
             std::size_t most_places);

/// None if it would take more than most_places, or so many vertices that it would look likely.
std::optional<SurfaceCache> make_body_cache(const PrecomputeInput& input, const Body& group,
                                            std::size_t most_places);

}  // namespace opaline
