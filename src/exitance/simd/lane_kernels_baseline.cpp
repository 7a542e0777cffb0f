// SPDX-License-Identifier: GPL-3.0-or-later
#include <emmintrin.h>

#include "exitance/simd/lane_kernels.h"
#include "opaline/error.h"

namespace opaline {
namespace {

#include "exitance/simd/lanes_baseline.inl"
// On these vectors:
#include "exitance/simd/lane_kernels.inl"

}  // namespace

const LaneKernels kBaselineKernels{"baseline", judge_baseline, expand, add_expansion, add_nodes, add_leaves};

MachineSets this_machine() {
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return {avx2, avx2 && __builtin_cpu_supports("avx512f")};
}

const LaneKernels& lane_kernels(InstructionSet wanted, const MachineSets& machine) {
  const auto missing = [](const char* name) {
    return Error(ErrorKind::bad_input, {}, 0, 0,
                 "settings.laboratory.instruction_set: not supported by this processor", "\"automatic\"",
                 name);
  };
  switch (wanted) {
    case InstructionSet::baseline:
      return kBaselineKernels;
    case InstructionSet::avx2:
      if (!machine.avx2) throw missing("avx2");
      return kAvx2Kernels;
    case InstructionSet::avx512:
      if (!machine.avx512) throw missing("avx512");
      return kAvx512Kernels;
    case InstructionSet::automatic:
      break;
  }
  return machine.avx512 ? kAvx512Kernels : machine.avx2 ? kAvx2Kernels : kBaselineKernels;
}

}  // namespace opaline
