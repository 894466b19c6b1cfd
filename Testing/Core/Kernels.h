// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

#include <string>
#include <vector>

/// Names of the kernels that this machine runs.
inline std::vector<std::string> UsableKernels()
{
  std::vector<std::string> names;
  for (const inr::InstructionSet set :
       {inr::InstructionSet::Baseline, inr::InstructionSet::Avx2, inr::InstructionSet::Avx512}) {
    if (inr::IsUsable(set)) {
      names.emplace_back(inr::InstructionSetName(set));
    }
  }
  return names;
}
