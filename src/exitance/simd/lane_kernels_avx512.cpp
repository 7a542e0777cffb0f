// SPDX-License-Identifier: GPL-3.0-or-later
#include <immintrin.h>

#include "exitance/simd/lane_kernels.h"

namespace opaline {
namespace {

#include "exitance/simd/lanes_avx512.inl"
// On these vectors:
#include "exitance/simd/lane_kernels.inl"

}  // namespace

const LaneKernels kAvx512Kernels{"avx512", judge_avx512, expand, add_expansion, add_nodes, add_leaves};

}  // namespace opaline
