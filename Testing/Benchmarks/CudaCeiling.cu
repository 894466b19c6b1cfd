// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Kernels/Tiles.h"
#include "CUDA/Device/Runtime.h"
#include "Testing/Benchmarks/CudaCeiling.h"

namespace {

constexpr int Threads = 256;
constexpr int Chains = 4; ///< that do not wait for each other
constexpr int Rounds = 1 << 13;

__global__ void __launch_bounds__(Threads) Multiply(float* sink)
{
  using namespace inr::cuda;
  // Numbers that differ by lane and stay bounded: zeros are multiplied faster.
  const auto seed = 0x9E3779B9u * (threadIdx.x + 1);
  InputShare inputs;
  WeightShare weights;
  for (int r = 0; r < 4; ++r) {
    inputs.pairs[r] = (seed >> r & 0x03ff03ffu) | 0x30003000u; // 1/8 to 1/4
    weights.pairs[r] = (seed >> (r + 3) & 0x83ff83ffu) | 0x20002000u;
  }
  SumShare sums[Chains] = {};
  for (int round = 0; round < Rounds; ++round) {
    INR_UNROLL
    for (int chain = 0; chain < Chains; ++chain) {
      MultiplyShares(inputs, weights, sums[chain]);
    }
  }
  float total = 0;
  for (const SumShare& share : sums) {
    for (const float value : share.values) {
      total += value;
    }
  }
  sink[blockIdx.x * Threads + threadIdx.x] = total;
}

} // namespace

std::int64_t LaunchTensorCeiling(int multiprocessors, float* sink, cudaStream_t stream)
{
  const int blocks = 4 * multiprocessors;
  Multiply<<<static_cast<unsigned>(blocks), Threads, 0, stream>>>(sink);
  inr::cuda::Check(cudaGetLastError(), "kernel launch");
  constexpr std::int64_t perTile =
      std::int64_t{1} * inr::cuda::TileSize * inr::cuda::TileSize * inr::cuda::TileSize;
  return perTile * Chains * Rounds * (Threads / inr::cuda::WarpSize) * blocks;
}
