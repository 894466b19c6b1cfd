// SPDX-License-Identifier: BSD-3-Clause
//
// Products of tiles as in Tiles.h, of float32 numbers. Tensor cores multiply numbers of 11 bits and
// float32's range (tf32, of compute capability 8.0 on): an input is the sum of two of them, and
// what the second one leaves out is 2^-22 of it. So is a weight; where all weights are numbers of
// 11 bits, as those of models in half precision are, they have no second part.
//
// The lanes' shares are those of sums, so that a layer's results are the inputs of the next one
// here, too: mma.m16n8k8 does not care in which order the eight inputs of a product come, as long
// as it is the same for both factors.
#pragma once

#include "CUDA/Device/Kernels/Tiles.h"

namespace inr {
namespace cuda {

/// Value v of lane L: sample RowOf(L) + 8 * (v / 2 % 2), input ColumnOf(L) + v % 2 + 8 * (v / 4).
struct WideInputShare
{
  float first[8];
  float second[8];
};

/// Value v of lane L for one half of a tile's outputs, the first or the last eight: output RowOf(L)
/// of these, input ColumnOf(L) + v % 2 + 8 * (v / 2).
struct alignas(16) WideWeightShare
{
  float values[4];
};

constexpr std::uint32_t BeyondElevenBits = 0x1fffu;

/// The nearest number of 11 bits; infinite where that is beyond float's range.
INR_HOST_DEVICE inline float ToElevenBits(float value)
{
  return FloatOf((BitsOf(value) + (BeyondElevenBits + 1) / 2) & ~BeyondElevenBits);
}

/// What of a number the tensor cores look at.
INR_HOST_DEVICE inline float CutToElevenBits(float value)
{
  return FloatOf(BitsOf(value) & ~BeyondElevenBits);
}

INR_HOST_DEVICE inline WideInputShare SplitInputs(const SumShare& values)
{
  WideInputShare share;
  INR_UNROLL
  for (int v = 0; v < 8; ++v) {
    share.first[v] = ToElevenBits(values.values[v]);
    share.second[v] = values.values[v] - share.first[v];
  }
  return share;
}

/// A lane's share of a tile of inputs, 16 rows of `stride` floats (even) in shared memory. Free of
/// bank conflicts where `stride` is 8 more than a multiple of 16.
INR_HOST_DEVICE inline SumShare LoadWideInputs(const float* rows, int stride, int lane)
{
  SumShare share;
  INR_UNROLL
  for (int v = 0; v < 8; v += 2) {
    const float* const from =
        rows + (RowOf(lane) + 8 * (v / 2 % 2)) * stride + ColumnOf(lane) + 8 * (v / 4);
    share.values[v] = from[0];
    share.values[v + 1] = from[1];
  }
  return share;
}

/// sums += inputs * weights, as MultiplyTiles of Tiles.h, for one half of the outputs;
/// `valueOf(share, v)` is value v of a lane's input.
template <class Inputs, class Weights, class Sums, class ValueOf>
void MultiplyWideTiles(const Inputs& inputs, const Weights& weights, int half, const Sums& sums,
                       const ValueOf& valueOf)
{
  double a[TileSize][TileSize];     // of sample and input
  double b[TileSize / 2][TileSize]; // of output and input
  for (int lane = 0; lane < WarpSize; ++lane) {
    const int row = RowOf(lane);
    const int column = ColumnOf(lane);
    for (int v = 0; v < 8; ++v) {
      a[row + 8 * (v / 2 % 2)][column + v % 2 + 8 * (v / 4)] = valueOf(inputs(lane), v);
    }
    for (int v = 0; v < 4; ++v) {
      b[row][column + v % 2 + 8 * (v / 2)] = static_cast<double>(weights(lane).values[v]);
    }
  }
  for (int lane = 0; lane < WarpSize; ++lane) {
    for (int v = 0; v < 4; ++v) {
      const double* const from = a[RowOf(lane) + 8 * (v / 2)];
      const double* const factors = b[ColumnOf(lane) + v % 2];
      float& sum = sums(lane).values[4 * half + v];
      double exact = static_cast<double>(sum);
      for (int k = 0; k < TileSize; ++k) {
        exact += from[k] * factors[k];
      }
      sum = static_cast<float>(exact);
    }
  }
}

/// Both parts of an input, as the tensor cores see them.
inline double BothParts(const WideInputShare& share, int v)
{
  return static_cast<double>(share.first[v]) +
         static_cast<double>(CutToElevenBits(share.second[v]));
}
inline double FirstPart(const WideInputShare& share, int v)
{
  return static_cast<double>(share.first[v]);
}

/// The k-th of a lane's registers for mma.m16n8k8 with one half of the inputs.
INR_HOST_DEVICE inline float RegisterOfA(const float (&inputs)[8], int part, int k)
{
  return inputs[4 * part + k % 2 * 2 + k / 2]; // its rows come first, ours its columns
}
INR_HOST_DEVICE inline float RegisterOfB(const WideWeightShare& weights, int part, int k)
{
  return weights.values[2 * part + k];
}

#ifdef __CUDACC__

/// sums += inputs * weights by the calling lane's warp, for one half of the outputs; one part of
/// the inputs.
INR_HOST_DEVICE inline void MultiplyWideShares(const float (&inputs)[8],
                                               const WideWeightShare& weights, int half,
                                               SumShare& sums)
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  float* const c = sums.values + 4 * half;
  INR_UNROLL
  for (int part = 0; part < 2; ++part) { // of the inputs
    const auto a = [&](int k) { return __float_as_uint(RegisterOfA(inputs, part, k)); };
    const auto b = [&](int k) { return __float_as_uint(RegisterOfB(weights, part, k)); };
    asm volatile(
        "mma.sync.aligned.m16n8k8.row.col.f32.tf32.tf32.f32 {%0, %1, %2, %3}, {%4, %5, %6, %7}, "
        "{%8, %9}, {%0, %1, %2, %3};"
        : "+f"(c[0]), "+f"(c[1]), "+f"(c[2]), "+f"(c[3])
        : "r"(a(0)), "r"(a(1)), "r"(a(2)), "r"(a(3)), "r"(b(0)), "r"(b(1)));
  }
#else
  static_cast<void>(inputs);
  static_cast<void>(weights);
  static_cast<void>(half);
  static_cast<void>(sums);
#ifdef __CUDA_ARCH__
  __trap(); // nobody begins such a kernel there: see DeviceModel
#endif
#endif
}

#endif // __CUDACC__

} // namespace cuda
} // namespace inr
