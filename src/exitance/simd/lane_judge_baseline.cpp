// SPDX-License-Identifier: GPL-3.0-or-later
#include <immintrin.h>

#include "exitance/simd/lane_kernels.h"

namespace opaline {
namespace {

#include "exitance/simd/lanes_baseline.inl"
// On these vectors:
#include "exitance/simd/lane_judge.inl"

}  // namespace

Verdict judge_baseline(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster) {
  return judge(input, sources, cluster);
}

}  // namespace opaline
