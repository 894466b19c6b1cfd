// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InferenceKernels.h"
#include "Testing/Core/Inference/LongDoubleTruth.h"
#include "Testing/Core/Kernels.h"
#ifdef __x86_64__
#include "Testing/Core/Inference/TileImitation.h"
#include "Testing/Core/Inference/TileTraps.h"
#endif

#include <memory>
#include <string>
#include <vector>

/// The bounds that Evaluator.h states.
inline RoundedProducts ProductsOf(const inr::InferenceKernels& kernels)
{
  return kernels.layout == inr::WeightLayout::SplitTiles
             ? RoundedProducts{3 * 0x1p-16L + 0x1p-32L, 3}
             : RoundedProducts{0x1p-7L + 0x1p-16L, 1};
}

/// All that compute with bfloat16 numbers, or sums of two, on this machine: with AVX512-BF16, with
/// tiles built for an imitation of them and, as long as this lives, with those built for the
/// processor, whose instructions are imitated where it lacks them. One where it has them but may
/// not use them.
class RoundingKernels
{
public:
#ifdef __x86_64__
  RoundingKernels()
  {
    if (!inr::IsUsable(inr::InferencePrecision::BFloat16, inr::InstructionSet::Avx512)) {
      return;
    }
    this->All = {inr::PairKernels(), ImitatedKernels(), ImitatedSplitKernels()};
    if (inr::IsTileKernelUsable() || !imitation::HasTileInstructions()) {
      this->All.push_back(inr::TileKernels());
      this->All.push_back(inr::SplitTileKernels());
      this->Traps = std::make_unique<imitation::TileTraps>();
    }
  }
#endif

  bool empty() const { return this->All.empty(); }
  auto begin() const { return this->All.begin(); }
  auto end() const { return this->All.end(); }

private:
  std::vector<inr::InferenceKernels> All;
#ifdef __x86_64__
  std::unique_ptr<imitation::TileTraps> Traps;
#endif
};

/// Those, and the ones for float32 that this machine runs.
inline std::vector<inr::InferenceKernels> AllKernels(const RoundingKernels& rounding)
{
  std::vector<inr::InferenceKernels> all(rounding.begin(), rounding.end());
  for (const std::string& kernel : UsableKernels()) {
    all.push_back(inr::FloatKernels(inr::ChooseInstructionSet(kernel)));
  }
  return all;
}
