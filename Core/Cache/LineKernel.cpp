// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Core/Inference/Lanes.h.
#include "Core/Cache/LineKernel.h"

namespace inr {
namespace INR_ISA {

namespace {

float Larger(float a, float b) { return a > b ? a : b; }

/// The largest sums of errors that end somewhere on a line.
void AddUp(const float* __restrict errors, const float* __restrict inside,
           const float* __restrict before, float* __restrict now, float* __restrict most,
           std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    now[k] = inside[k] * Larger(before[k] + errors[k], 0.0f);
    most[k] = Larger(now[k], most[k]);
  }
}

/// The same of their opposites.
void AddDown(const float* __restrict errors, const float* __restrict inside,
             const float* __restrict before, float* __restrict now, float* __restrict most,
             std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    now[k] = inside[k] * Larger(before[k] - errors[k], 0.0f);
    most[k] = Larger(now[k], most[k]);
  }
}

void AddMagnitudes(const float* __restrict errors, const float* __restrict inside,
                   const float* __restrict before, float* __restrict now, float* __restrict most,
                   float* __restrict largest, std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    const float magnitude = errors[k] < 0.0f ? -errors[k] : errors[k];
    now[k] = inside[k] * (before[k] + magnitude);
    most[k] = Larger(now[k], most[k]);
    largest[k] = Larger(magnitude, largest[k]);
  }
}

void Add(const LineSlice& slice, std::int64_t count)
{
  AddUp(slice.errors, slice.inside, slice.rises, slice.nextRises, slice.sums, count);
  AddDown(slice.errors, slice.inside, slice.falls, slice.nextFalls, slice.sums, count);
  AddMagnitudes(slice.errors, slice.inside, slice.magnitudes, slice.nextMagnitudes, slice.amounts,
                slice.largest, count);
}

} // namespace

const LineKernel Lines = {Add};

} // namespace INR_ISA
} // namespace inr
