// SPDX-License-Identifier: BSD-3-Clause
//
// What tests want of the imitated tiles, and kernels that are built with them.
#pragma once

#include "Core/Inference/InferenceKernels.h"
#include "Testing/Core/Inference/ImitatedTiles.h"

#include <stdexcept>

namespace imitation {

/// Where the processor would raise an exception.
class TileFault : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// A unit that does not work.
enum class Defect {
  None,
  LosesUpperHalves, ///< of the pairs
  LosesLastPair,
  LosesLastRow,
  LosesSmallDigits, ///< of the sums
  ForgetsSums,      ///< those before the last tile of columns
  SwapsSamples
};

/// Of this thread's tiles from now on.
void Have(Defect defect);

bool IsConfigured();
/// How often this thread's were.
int Configurations();

} // namespace imitation

namespace inr {
namespace imitatedtiles {
extern const EvaluateKernel Evaluate;
extern const GridKernel Grid;
} // namespace imitatedtiles
namespace imitatedsplit {
extern const EvaluateKernel Evaluate;
extern const GridKernel Grid;
} // namespace imitatedsplit
} // namespace inr

/// Those of tiles on an imitation of them; they need AVX512-BF16.
inline inr::InferenceKernels ImitatedKernels()
{
  return {"imitated tiles", &inr::imitatedtiles::Evaluate, &inr::imitatedtiles::Grid,
          inr::WeightLayout::Tiles};
}
/// The same of sums of two numbers.
inline inr::InferenceKernels ImitatedSplitKernels()
{
  return {"imitated tiles, split", &inr::imitatedsplit::Evaluate, &inr::imitatedsplit::Grid,
          inr::WeightLayout::SplitTiles};
}
