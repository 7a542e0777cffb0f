// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over single samples at a packet, and their exitance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/evaluate.h"
#include "exitance/simd/lane_kernels.h"

namespace opaline {

/// Adds the samples of leaves, those of another sheet with their whole kernel. room: scratch
void add_samples(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                 const std::vector<std::uint32_t>& leaves, const Packet& packet, PacketSums& sums,
                 std::vector<std::uint32_t>& room);

/// Sets the exitance of the queries in a packet's lanes.
void set_exitance(const EvaluateInput& input, const PacketSums& sums, std::span<const std::uint32_t> queries,
                  std::span<Exitance> result);

}  // namespace opaline
