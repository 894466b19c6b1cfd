// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

#include <cstdint>

namespace inr {

/// A row of samples, each the mean of two values; places are apart by `stride`.
struct LineSamples
{
  const float* first;
  const float* second;
  const float* fine; ///< what they are taken for, at the samples' own places
  std::int64_t stride;
  float* errors;  ///< sums of sample minus value,
  float* amounts; ///< of magnitudes
  float* largest; ///< and the largest magnitude
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
  /// Adds what samples `begin` to `end` - 1 get wrong about the values `offset` away, `weight`
  /// times.
  void (*compare)(const LineSamples& samples, std::int64_t offset, float weight, std::int64_t begin,
                  std::int64_t end);
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
