// SPDX-License-Identifier: GPL-3.0-or-later
// What is summed sample by sample at a packet, and what its sums come to.
#pragma once

#include <vector>

#include "evaluate/lane_kernels.h"
#include "opaline/evaluate/evaluate.h"

namespace opaline {

/// Adds the samples of leaves, those of another sheet with their whole kernel. room: scratch
void add_samples(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                 const std::vector<std::uint32_t>& leaves, const Packet& packet, PacketSums& sums,
                 std::vector<std::uint32_t>& room);

/// Of the query that stands in one lane.
Exitance exitance_of(const EvaluateInput& input, const PacketSums& sums, std::size_t lane,
                     std::uint32_t query);

}  // namespace opaline
