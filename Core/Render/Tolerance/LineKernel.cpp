// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Core/Inference/Lanes.h.
#include "Core/Render/Tolerance/LineKernel.h"

namespace inr {
namespace INR_ISA {

namespace {

float Larger(float a, float b) { return a > b ? a : b; }

/// Rows are short: their last vectors overlap the ones before, as nothing is slower than the rest
/// of a loop.
constexpr std::int64_t Together = 16;

template <int Values, std::int64_t Count>
void CompareSome(const float* __restrict first, const float* __restrict second,
                 const float* __restrict fine, std::int64_t step, float* __restrict errors,
                 float* __restrict amounts, float* __restrict largest)
{
  for (std::int64_t k = 0; k < Count; ++k) {
    const float sample = 0.5f * (first[k] + second[k]);
    float sum = 0.0f;
    float amount = 0.0f;
    float most = largest[k];
#pragma GCC unroll 9
    for (int value = 0; value < Values; ++value) {
      const bool isEnd = Values > 1 && Values % 2 == 1 && (value == 0 || value == Values - 1);
      const float weight = isEnd ? 0.5f : 1.0f;
      const float error = sample - fine[k + value * step];
      const float magnitude = error < 0.0f ? -error : error;
      sum += weight * error;
      amount += weight * magnitude;
      most = Larger(magnitude, most);
    }
    errors[k] = sum;
    amounts[k] = amount;
    largest[k] = most;
  }
}

template <int Values, std::int64_t Count>
void CompareFrom(const LineSamples& samples, std::int64_t row, std::int64_t begin)
{
  const std::int64_t from = row * samples.pitch + begin;
  const std::int64_t to = row * samples.nextRow + begin;
  CompareSome<Values, Count>(samples.first + from, samples.second + from, samples.fine + from,
                             samples.step, samples.errors + to, samples.amounts + to,
                             samples.largest + to);
}

template <int Values>
void CompareRows(const LineSamples& samples, std::int64_t rows, std::int64_t count)
{
  for (std::int64_t row = 0; row < rows; ++row) {
    if (count < Together) {
      for (std::int64_t k = 0; k < count; ++k) {
        CompareFrom<Values, 1>(samples, row, k);
      }
      continue;
    }
    for (std::int64_t k = 0; k + Together < count; k += Together) {
      CompareFrom<Values, Together>(samples, row, k);
    }
    CompareFrom<Values, Together>(samples, row, count - Together);
  }
}

void Compare(const LineSamples& samples, int values, std::int64_t rows, std::int64_t count)
{
  switch (values) {
  case 1:
    return CompareRows<1>(samples, rows, count);
  case 2:
    return CompareRows<2>(samples, rows, count);
  case 3:
    return CompareRows<3>(samples, rows, count);
  case 4:
    return CompareRows<4>(samples, rows, count);
  case 5:
    return CompareRows<5>(samples, rows, count);
  case 8:
    return CompareRows<8>(samples, rows, count);
  case 9:
    return CompareRows<9>(samples, rows, count);
  }
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
