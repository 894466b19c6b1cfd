// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Core/Inference/Lanes.h.
#include "Core/Cache/LineKernel.h"

namespace inr {
namespace INR_ISA {

namespace {

float Larger(float a, float b) { return a > b ? a : b; }

/// One stride is what nearly all rows have, which the compiler has to be told.
template <bool Contiguous>
void CompareRow(const float* __restrict first, const float* __restrict second,
                const float* __restrict fine, std::int64_t stride, float weight,
                float* __restrict errors, float* __restrict amounts, float* __restrict largest,
                std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t at = Contiguous ? k : k * stride;
    const float error = 0.5f * (first[at] + second[at]) - fine[at];
    const float magnitude = error < 0.0f ? -error : error;
    errors[k] += weight * error;
    amounts[k] += weight * magnitude;
    largest[k] = Larger(magnitude, largest[k]);
  }
}

void Compare(const LineSamples& samples, std::int64_t offset, float weight, std::int64_t begin,
             std::int64_t end)
{
  const std::int64_t from = begin * samples.stride;
  const auto compare = samples.stride == 1 ? CompareRow<true> : CompareRow<false>;
  compare(samples.first + from, samples.second + from, samples.fine + from + offset, samples.stride,
          weight, samples.errors + begin, samples.amounts + begin, samples.largest + begin,
          end - begin);
}

/// The largest sums of errors, or of their opposites, that end somewhere on a line.
template <int Sign>
void AddSums(const float* __restrict errors, const float* __restrict inside,
             const float* __restrict before, float* __restrict now, float* __restrict most,
             std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    now[k] = inside[k] * Larger(before[k] + Sign * errors[k], 0.0f);
    most[k] = Larger(now[k], most[k]);
  }
}

void AddAmounts(const float* __restrict amounts, const float* __restrict inside,
                const float* __restrict before, float* __restrict now, float* __restrict most,
                std::int64_t count)
{
  for (std::int64_t k = 0; k < count; ++k) {
    now[k] = inside[k] * (before[k] + amounts[k]);
    most[k] = Larger(now[k], most[k]);
  }
}

void Add(const LineSlice& slice, std::int64_t count)
{
  AddSums<1>(slice.errors, slice.inside, slice.rises, slice.nextRises, slice.sums, count);
  AddSums<-1>(slice.errors, slice.inside, slice.falls, slice.nextFalls, slice.sums, count);
  AddAmounts(slice.amounts, slice.inside, slice.magnitudes, slice.nextMagnitudes, slice.totals,
             count);
}

} // namespace

const LineKernel Lines = {Compare, Add};

} // namespace INR_ISA
} // namespace inr
