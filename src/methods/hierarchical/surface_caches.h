// SPDX-License-Identifier: GPL-3.0-or-later
// Choice of bodies with a surface cache.
#pragma once

#include <optional>
#include <vector>

#include "bodies/body.h"
#include "exitance/surface_cache.h"

namespace opaline {

/// Maximum points of a body's surface cache on request, and bytes of a point during its construction
/// (bench_plan). Surfaces exceeding it, such as needles cut into squares of the near field's size, are
/// evaluated at the image's points.
std::size_t most_wanted_places(const BodyPlan& group, const World& world);
inline constexpr std::size_t kBytesOfPlace = 160;
/// Expected points of such a cache, at most most_wanted_places.
std::size_t expected_cache_places(const Scene& scene, const BodyPlan& group, const World& world);

/// Maximum points of a surface cache, one per body of the plan: most_wanted_places if the settings request a
/// cache, 0 if they request another evaluator, otherwise a fraction of the body's visible points times the
/// images. A crop counts as the full image, to have the same pixels. 0 with a tint of transmitted light, too
/// detailed for a cache.
std::vector<std::size_t> most_cache_places(const PrecomputeInput& input, std::span<const Body> groups,
                                           std::size_t pictures = 1);

/// True if make_body_cache would make this cache.
bool may_use(const SurfaceCache& cache, const PrecomputeInput& input, const Body& group,
             std::size_t most_places);

/// Makes a surface cache; none if it exceeds most_places, or has so many vertices that it would.
std::optional<SurfaceCache> make_body_cache(const PrecomputeInput& input, const Body& group,
                                            std::size_t most_places);

}  // namespace opaline
