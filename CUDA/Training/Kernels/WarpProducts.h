// SPDX-License-Identifier: BSD-3-Clause
//
// Products of matrices in float32, a tile of 32 x 32 results by one warp, for matrices of any size.
//
// A lane holds 8 x 4 results in registers and, for each step of depth, reads 12 numbers that the
// warp has put into shared memory: three reads of 16 bytes for 32 multiplications. The order of a
// sum is that of depth, whoever computes it.
#pragma once

#include "CUDA/Device/Kernels/Block.h"

#include <cstdint>

namespace inr {
namespace cuda {

constexpr int ProductTile = 32;
constexpr int ProductDepth = 16;
constexpr int ProductRows = 8; ///< of a lane
constexpr int ProductColumns = 4;

/// Floats from one step of depth to the next in shared memory: aligned to 16 bytes.
constexpr int ProductStride = ProductTile + 4;

/// Floats of shared memory that a warp takes: two panels.
constexpr int ProductShared = 2 * ProductDepth * ProductStride;

struct alignas(16) FourFloats
{
  float values[4];
};

struct ProductSums
{
  float values[ProductRows][ProductColumns];
};

/// On the host without the fused instruction, which many processors' compilers turn into a call.
INR_HOST_DEVICE inline float MultiplyAdd(float a, float b, float c)
{
#ifdef __CUDA_ARCH__
  return fmaf(a, b, c);
#else
  return a * b + c;
#endif
}

INR_HOST_DEVICE inline std::int64_t TilesOf(std::int64_t size)
{
  return (size + ProductTile - 1) / ProductTile;
}

/// The calling lane's share of a panel: from(i, k) for i < size, k < depth, and zeros beyond.
/// `AlongDepth`: numbers lie side by side in memory along k, else along i.
template <bool AlongDepth, class From>
INR_HOST_DEVICE inline void StagePanel(int lane, float* panel, int size, int depth,
                                       const From& from)
{
  constexpr int count = ProductTile * ProductDepth / WarpSize;
  const auto rowOf = [&](int n) {
    return AlongDepth ? n * (WarpSize / ProductDepth) + lane / ProductDepth : lane;
  };
  const auto stepOf = [&](int n) { return AlongDepth ? lane % ProductDepth : n; };
  float numbers[count]; // all of them on their way before the first is written
  INR_UNROLL
  for (int n = 0; n < count; ++n) {
    const bool is = rowOf(n) < size && stepOf(n) < depth;
    numbers[n] = is ? from(rowOf(n), stepOf(n)) : 0.0f;
  }
  INR_UNROLL
  for (int n = 0; n < count; ++n) {
    panel[stepOf(n) * ProductStride + rowOf(n)] = numbers[n];
  }
}

INR_HOST_DEVICE inline void AddPanels(const float* left, const float* right, ProductSums& sums)
{
  INR_UNROLL
  for (int k = 0; k < ProductDepth; ++k) {
    const auto* const a = reinterpret_cast<const FourFloats*>(left + k * ProductStride);
    const FourFloats rows[2] = {a[0], a[1]};
    const FourFloats b = *reinterpret_cast<const FourFloats*>(right + k * ProductStride);
    INR_UNROLL
    for (int i = 0; i < ProductRows; ++i) {
      INR_UNROLL
      for (int j = 0; j < ProductColumns; ++j) {
        sums.values[i][j] = MultiplyAdd(rows[i / 4].values[i % 4], b.values[j], sums.values[i][j]);
      }
    }
  }
}

/// store(lane, i, j, sum of left(i, k) * right(j, k) over k < depth) for i < rows, j < columns, at
/// most ProductTile each. `shared`: ProductShared floats of the warp's own, aligned to 16 bytes.
template <bool LeftAlongDepth, bool RightAlongDepth, class Warp, class Left, class Right,
          class Store>
INR_HOST_DEVICE inline void MultiplyTile(Warp& warp, float* shared, int rows, int columns,
                                         std::int64_t depth, const Left& left, const Right& right,
                                         const Store& store)
{
  constexpr int across = ProductTile / ProductColumns; // lanes
  float* const others = shared + ProductShared / 2;
  typename Warp::template PerLane<ProductSums> sums;
  warp.lanes([&](int lane) { sums[lane] = ProductSums{}; });
  for (std::int64_t first = 0; first < depth; first += ProductDepth) {
    const auto deep = static_cast<int>(depth - first < ProductDepth ? depth - first : ProductDepth);
    warp.exchange([&](int lane) {
      StagePanel<LeftAlongDepth>(lane, shared, rows, deep,
                                 [&](int i, int k) { return left(i, first + k); });
      StagePanel<RightAlongDepth>(lane, others, columns, deep,
                                  [&](int j, int k) { return right(j, first + k); });
    });
    warp.lanes([&](int lane) {
      const int row = lane / across * ProductRows;
      const int column = lane % across * ProductColumns;
      if (row < rows && column < columns) {
        AddPanels(shared + row, others + column, sums[lane]);
      }
    });
  }
  warp.lanes([&](int lane) {
    const int row = lane / across * ProductRows;
    const int column = lane % across * ProductColumns;
    INR_UNROLL
    for (int i = 0; i < ProductRows; ++i) {
      INR_UNROLL
      for (int j = 0; j < ProductColumns; ++j) {
        if (row + i < rows && column + j < columns) {
          store(lane, row + i, column + j, sums[lane].values[i][j]);
        }
      }
    }
  });
}

} // namespace cuda
} // namespace inr
