// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/InstructionSet.h"

#include "Core/Error.h"

namespace inr {

namespace {
constexpr InstructionSet BestFirst[] = {InstructionSet::Avx512, InstructionSet::Avx2,
                                        InstructionSet::Baseline};
}

const char* InstructionSetName(InstructionSet set)
{
  switch (set) {
  case InstructionSet::Avx512:
    return "avx512";
  case InstructionSet::Avx2:
    return "avx2";
  default:
    return "baseline";
  }
}

bool IsUsable(InstructionSet set)
{
#ifdef INR_X86_KERNELS
  switch (set) {
  case InstructionSet::Avx512:
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  case InstructionSet::Avx2:
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  default:
    return true;
  }
#else
  return set == InstructionSet::Baseline;
#endif
}

InstructionSet ChooseInstructionSet(const std::string& name)
{
  for (const InstructionSet set : BestFirst) {
    if (IsUsable(set) && (name.empty() || name == InstructionSetName(set))) {
      return set;
    }
  }
  throw Error(ErrorCode::Unsupported,
              "no inference kernel '" + name +
                  "' on this machine; known are baseline, avx2 and avx512 (empty = the fastest)");
}

} // namespace inr
