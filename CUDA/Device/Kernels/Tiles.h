// SPDX-License-Identifier: BSD-3-Clause
//
// Matrix products by warps: 16 samples x 16 inputs times 16 inputs x 16 outputs. Inputs and weights
// are half precision, products are exact and sums are float32.
//
// A lane's share of each matrix is what the tensor cores' instruction mma.m16n8k16 wants ("Matrix
// Fragments for mma.m16n8k16 with floating point type" of NVIDIA's PTX ISA), two of which, side by
// side, make a tile of 16 outputs. With these shares, the sums of one layer are, lane by lane, the
// inputs of the next one: nothing moves between lanes from layer to layer.
#pragma once

#include "CUDA/Device/Kernels/Half.h"

#ifdef __CUDA_ARCH__
#define INR_UNROLL _Pragma("unroll")
#define INR_UNROLL_BY(count) INR_PRAGMA(unroll count)
#define INR_PRAGMA(text) _Pragma(#text)
#else
#define INR_UNROLL
#define INR_UNROLL_BY(count)
#endif

namespace inr {
namespace cuda {

constexpr int WarpSize = 32;
constexpr int TileSize = 16;

/// Pair r of lane L: sample RowOf(L) + 8 * (r % 2), inputs ColumnOf(L) + 8 * (r / 2) and the next.
struct InputShare
{
  std::uint32_t pairs[4];
};

/// Pair r of lane L: output RowOf(L) + 8 * (r / 2), inputs ColumnOf(L) + 8 * (r % 2) and the next.
struct alignas(16) WeightShare
{
  std::uint32_t pairs[4];
};

/// Value v of lane L: sample RowOf(L) + 8 * (v / 2 % 2), output ColumnOf(L) + v % 2 + 8 * (v / 4).
struct SumShare
{
  float values[8];
};

INR_HOST_DEVICE constexpr int RowOf(int lane) { return lane / 4; }
INR_HOST_DEVICE constexpr int ColumnOf(int lane) { return lane % 4 * 2; }

/// A lane's share of a tile of inputs, 16 rows of `stride` halves (even) in shared memory. Free of
/// bank conflicts where `stride` is 8 more than a multiple of 16.
INR_HOST_DEVICE inline InputShare LoadInputs(const HalfBits* rows, int stride, int lane)
{
  InputShare share;
  INR_UNROLL
  for (int r = 0; r < 4; ++r) {
    const HalfBits* const from =
        rows + (RowOf(lane) + 8 * (r % 2)) * stride + ColumnOf(lane) + 8 * (r / 2);
    share.pairs[r] = *reinterpret_cast<const PairBits*>(from);
  }
  return share;
}

/// sums += inputs * weights, given functions from a lane to its share. Each product is exact, and
/// 16 of them and the sum before are added up in float64 and rounded once; what tensor cores round
/// in between is not documented, and less than float32 would.
template <class Inputs, class Weights, class Sums>
void MultiplyTiles(const Inputs& inputs, const Weights& weights, const Sums& sums)
{
  float a[TileSize][TileSize]; // of sample and input
  float b[TileSize][TileSize]; // of output and input
  for (int lane = 0; lane < WarpSize; ++lane) {
    const int row = RowOf(lane);
    const int column = ColumnOf(lane);
    for (int r = 0; r < 4; ++r) {
      const std::uint32_t pairs[2] = {inputs(lane).pairs[r], weights(lane).pairs[r]};
      a[row + 8 * (r % 2)][column + 8 * (r / 2)] = LowHalf(pairs[0]);
      a[row + 8 * (r % 2)][column + 8 * (r / 2) + 1] = HighHalf(pairs[0]);
      b[row + 8 * (r / 2)][column + 8 * (r % 2)] = LowHalf(pairs[1]);
      b[row + 8 * (r / 2)][column + 8 * (r % 2) + 1] = HighHalf(pairs[1]);
    }
  }
  for (int lane = 0; lane < WarpSize; ++lane) {
    for (int v = 0; v < 8; ++v) {
      const float* const from = a[RowOf(lane) + 8 * (v / 2 % 2)];
      const float* const factors = b[ColumnOf(lane) + v % 2 + 8 * (v / 4)];
      double sum = static_cast<double>(sums(lane).values[v]);
      for (int k = 0; k < TileSize; ++k) {
        sum += static_cast<double>(from[k]) * static_cast<double>(factors[k]);
      }
      sums(lane).values[v] = static_cast<float>(sum);
    }
  }
}

#ifdef __CUDACC__

/// The same by the calling lane's warp; all of its lanes take part.
INR_HOST_DEVICE inline void MultiplyShares(const InputShare& inputs, const WeightShare& weights,
                                           SumShare& sums)
{
#ifdef __CUDA_ARCH__
  INR_UNROLL
  for (int half = 0; half < 2; ++half) { // of the outputs
    const std::uint32_t* const b = weights.pairs + 2 * half;
    float* const c = sums.values + 4 * half;
#if __CUDA_ARCH__ >= 800
    asm volatile(
        "mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32 {%0, %1, %2, %3}, {%4, %5, %6, %7}, "
        "{%8, %9}, {%0, %1, %2, %3};"
        : "+f"(c[0]), "+f"(c[1]), "+f"(c[2]), "+f"(c[3])
        : "r"(inputs.pairs[0]), "r"(inputs.pairs[1]), "r"(inputs.pairs[2]), "r"(inputs.pairs[3]),
          "r"(b[0]), "r"(b[1]));
#else // Turing multiplies eight inputs at a time
    INR_UNROLL
    for (int part = 0; part < 2; ++part) {
      asm volatile(
          "mma.sync.aligned.m16n8k8.row.col.f32.f16.f16.f32 {%0, %1, %2, %3}, {%4, %5}, {%6}, "
          "{%0, %1, %2, %3};"
          : "+f"(c[0]), "+f"(c[1]), "+f"(c[2]), "+f"(c[3])
          : "r"(inputs.pairs[2 * part]), "r"(inputs.pairs[2 * part + 1]), "r"(b[part]));
    }
#endif
  }
#else
  static_cast<void>(inputs);
  static_cast<void>(weights);
  static_cast<void>(sums);
#endif
}

#endif // __CUDACC__

} // namespace cuda
} // namespace inr
