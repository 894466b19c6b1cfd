// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

#include <cstdint>

namespace inr {

/// Rows of samples, each the mean of two values, side by side in every array.
struct LineSamples
{
  const float* first;
  const float* second;
  const float* fine;    ///< the first value that they are taken for; none overlaps what is written
  std::int64_t step;    ///< from there to the next
  std::int64_t pitch;   ///< from row to row of all these
  float* errors;        ///< sums of sample minus value,
  float* amounts;       ///< of magnitudes
  float* largest;       ///< and the largest magnitude so far
  std::int64_t nextRow; ///< of these
};

/// A slice that lines pass, each with a number in every array; none of these overlap.
struct LineSlice
{
  const float* errors;
  const float* amounts;    ///< of the magnitudes of errors
  const float* inside;     ///< 1 where there are lines, 0 around them
  const float* rises;      ///< up to the sample before: the largest sums of errors that end there,
  const float* falls;      ///< of their opposites,
  const float* magnitudes; ///< and the sum of all amounts
  float* nextRises;        ///< up to this slice
  float* nextFalls;
  float* nextMagnitudes;
  float* sums;   ///< largest rise or fall so far
  float* totals; ///< largest sum of amounts
};

/// The inner loops of FindLineErrors, for one instruction set. All of them round alike.
struct LineKernel
{
  /// What samples get wrong about 1, 2, 3, 4, 5, 8 or 9 values each: of an odd number the first
  /// and the last count half, unless there is but one.
  void (*compare)(const LineSamples& samples, int values, std::int64_t rows, std::int64_t count);
  /// Adds that up along lines.
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
