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

// The built-in functions ask the operating system too (XGETBV): a set whose registers it does not
// save is reported as missing.
bool IsUsable(InstructionSet set)
{
#ifdef INR_X86_KERNELS
  switch (set) {
  case InstructionSet::Avx512: // and what its compiler flags imply: a virtual machine may hide any
    return IsUsable(InstructionSet::Avx2) && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl");
  case InstructionSet::Avx2:
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  default:
    return true;
  }
#else
  return set == InstructionSet::Baseline;
#endif
}

InstructionSet ChooseInstructionSet(const std::string& name, bool (*usable)(InstructionSet))
{
  for (const InstructionSet set : BestFirst) {
    const bool asked = name == InstructionSetName(set);
    if (usable(set) && (asked || name.empty())) {
      return set;
    }
    if (asked) {
      throw Error(ErrorCode::Unsupported,
                  "the kernel '" + name +
                      "' needs instructions that this processor, its operating system or this "
                      "build does not offer; ask for none by name and get the fastest that runs");
    }
  }
  throw Error(
      ErrorCode::Unsupported,
      "there is no kernel '" + name +
          "'; known are baseline, avx2 and avx512, to infer with also amx (empty = the fastest)");
}

} // namespace inr
