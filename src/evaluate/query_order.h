// SPDX-License-Identifier: GPL-3.0-or-later
// Query points in an order in which neighbours stand together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "opaline/evaluate/evaluate.h"

namespace opaline {

inline constexpr std::size_t kChunk = 256;  ///< queries that walk the tree together at first

/// Queries in chunks of kChunk neighbours; those that are not finite are left out: nothing reaches them.
std::vector<std::uint32_t> chunk_order(std::span<const Query> queries);

/// Cuts a chunk at the middle of its longest side, down to packets: compact boxes make short lists.
void sort_into_packets(std::span<std::uint32_t> chunk, std::span<const Query> queries);

}  // namespace opaline
