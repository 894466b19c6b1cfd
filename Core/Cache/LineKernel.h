// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

#include <cstdint>

namespace inr {

/// A slice that lines pass, each with a number in every array; none of these overlap.
struct LineSlice
{
  const float* errors;
  const float* inside;     ///< 1 where there are lines, 0 around them
  const float* rises;      ///< up to the slice before: the largest sums of errors that end there,
  const float* falls;      ///< of their opposites,
  const float* magnitudes; ///< and the sum of all their magnitudes
  float* nextRises;        ///< up to this slice
  float* nextFalls;
  float* nextMagnitudes;
  float* sums;    ///< largest rise or fall so far
  float* amounts; ///< largest sum of magnitudes
  float* largest; ///< largest magnitude
};

/// The inner loop of FindLineErrors, for one instruction set. All of them round alike.
struct LineKernel
{
  void (*add)(const LineSlice& slice, std::int64_t count);
};

/// The kernel built for `set`, which must be usable.
const LineKernel& LineKernelFor(InstructionSet set);

namespace baseline {
extern const LineKernel Lines;
}
namespace avx2 {
extern const LineKernel Lines;
}
namespace avx512 {
extern const LineKernel Lines;
}

} // namespace inr
