// SPDX-License-Identifier: GPL-3.0-or-later
// Query points in an order in which neighbours stand together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/evaluate.h"

namespace opaline {

inline constexpr std::size_t kChunk = 256;  ///< queries that walk the tree together at first

/// Queries in chunks of kChunk neighbours; those that are not finite are left out: nothing reaches them.
std::vector<std::uint32_t> chunk_order(std::span<const Query> queries);

/// Sorts a chunk into packets of at most kLanes queries: cut at the middle of the longest side, and again
/// where parts lie so far from each other that they have fewer neighbours within `reach`, mm, apart than
/// together.
PacketCut sort_into_packets(std::span<std::uint32_t> chunk, std::span<const Query> queries, float reach);

}  // namespace opaline
