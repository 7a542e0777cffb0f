// SPDX-License-Identifier: GPL-3.0-or-later
// Order of query points with neighbours together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/evaluate.h"

namespace opaline {

inline constexpr std::size_t kChunk = 256;  ///< queries beginning the traversal together

/// Order of the queries in chunks of kChunk neighbours; omits non-finite ones, as no light reaches them.
std::vector<std::uint32_t> chunk_order(std::span<const Query> queries);

/// Sorts a chunk into packets of at most kLanes queries: halves it along the longest side, and again if the
/// halves separately have fewer neighbours within `reach`, mm, than together.
PacketCut sort_into_packets(std::span<std::uint32_t> chunk, std::span<const Query> queries, float reach);

}  // namespace opaline
