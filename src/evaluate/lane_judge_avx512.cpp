// SPDX-License-Identifier: GPL-3.0-or-later
#include <immintrin.h>

#include "evaluate/lane_kernels.h"

namespace opaline {
namespace {

#include "evaluate/lanes_avx512.inl"
// On these vectors:
#include "evaluate/lane_judge.inl"

}  // namespace

Verdict judge_avx512(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster) {
  return judge(input, sources, cluster);
}

}  // namespace opaline
