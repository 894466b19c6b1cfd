// SPDX-License-Identifier: BSD-3-Clause
//
// Which lane has which element is written down here once more, from the tables of PTX's manual.
#include "CUDA/Inference/Kernels/FusedNetwork.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <vector>

namespace test::tiles {

using namespace inr::cuda;

/// A small integer: products and sums of a few hundred are exact.
float Small(std::uint64_t seed, int row, int column)
{
  const auto counter = static_cast<std::uint64_t>(row * TileSize + column);
  return static_cast<float>(inr::RandomBits(seed, counter) % 17) - 8.0f;
}

/// Of mma.m16n8k16's A, register r of a lane: rows groupID, +8, groupID, +8; columns below 8 first.
InputShare InputsOf(std::uint64_t seed, int lane)
{
  const int group = lane >> 2;
  const int thread = lane & 3;
  InputShare share{};
  for (int r = 0; r < 4; ++r) {
    const int row = group + (r == 1 || r == 3 ? 8 : 0);
    const int column = 2 * thread + (r >= 2 ? 8 : 0);
    share.pairs[r] = PackHalves(Small(seed, row, column), Small(seed, row, column + 1));
  }
  return share;
}

/// Of B, register r of two products side by side: rows (inputs) 2 * thread or +8, column groupID.
WeightShare WeightsOf(std::uint64_t seed, int lane)
{
  const int group = lane >> 2;
  const int thread = lane & 3;
  WeightShare share{};
  for (int r = 0; r < 4; ++r) {
    const int output = group + (r >= 2 ? 8 : 0);
    const int input = 2 * thread + (r % 2 == 1 ? 8 : 0);
    share.pairs[r] = PackHalves(Small(seed, output, input), Small(seed, output, input + 1));
  }
  return share;
}

/// Of C, value v of a lane: row, column.
void ExpectSums(const SumShare& share, int lane, const float (&expected)[TileSize][TileSize])
{
  const int group = lane >> 2;
  const int thread = lane & 3;
  for (int v = 0; v < 8; ++v) {
    const int row = group + (v % 4 >= 2 ? 8 : 0);
    const int column = 2 * thread + (v & 1) + (v >= 4 ? 8 : 0);
    EXPECT_EQ(share.values[v], expected[row][column]) << lane << " " << v;
  }
}

TEST(Tiles, MultiplyAsTheTensorCoresLayThemOut)
{
  HostWarp::PerLane<InputShare> inputs;
  HostWarp::PerLane<WeightShare> weights;
  HostWarp::PerLane<SumShare> sums;
  for (int lane = 0; lane < WarpSize; ++lane) {
    inputs[lane] = InputsOf(1, lane);
    weights[lane] = WeightsOf(2, lane);
    sums[lane] = {{1, 1, 1, 1, 1, 1, 1, 1}};
  }
  HostWarp::multiplyAdd(inputs, weights, sums);
  float expected[TileSize][TileSize];
  for (int sample = 0; sample < TileSize; ++sample) {
    for (int output = 0; output < TileSize; ++output) {
      expected[sample][output] = 1;
      for (int k = 0; k < TileSize; ++k) {
        expected[sample][output] += Small(1, sample, k) * Small(2, output, k);
      }
    }
  }
  for (int lane = 0; lane < WarpSize; ++lane) {
    ExpectSums(sums[lane], lane, expected);
  }
}

/// What mma.m16n8k8 makes of registers of tf32 numbers, by its tables: A's rows are groupID, +8,
/// groupID, +8 and its columns thread, thread, +4, +4; B's rows thread, +4, its column groupID.
void MultiplyByTheManual(const float (&a)[WarpSize][4], const float (&b)[WarpSize][2],
                         float (&sums)[16][8])
{
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 8; ++column) {
      for (int k = 0; k < 8; ++k) {
        const int laneOfA = row % 8 * 4 + k % 4;
        const int laneOfB = column * 4 + k % 4;
        sums[row][column] += a[laneOfA][row / 8 + 2 * (k / 4)] * b[laneOfB][k / 4];
      }
    }
  }
}

/// The registers that the device's code passes, in its order, are those of the tile that the host's
/// multiplies.
TEST(Tiles, OfFloatsMultiplyAsTheTensorCoresLayThemOut)
{
  HostWarp::PerLane<WideInputShare> inputs;
  HostWarp::PerLane<SumShare> sums;
  for (int lane = 0; lane < WarpSize; ++lane) {
    sums[lane] = SumShare{};
    for (int v = 0; v < 8; ++v) {
      inputs[lane].first[v] = Small(1, lane, v);
      inputs[lane].second[v] = 0.0f;
    }
  }
  for (int half = 0; half < 2; ++half) {
    HostWarp::PerLane<WideWeightShare> weights;
    float expected[16][8] = {};
    for (int lane = 0; lane < WarpSize; ++lane) {
      for (int v = 0; v < 4; ++v) {
        weights[lane].values[v] = Small(2 + static_cast<std::uint64_t>(half), lane, v);
      }
    }
    for (int part = 0; part < 2; ++part) {
      float a[WarpSize][4];
      float b[WarpSize][2];
      for (int lane = 0; lane < WarpSize; ++lane) {
        for (int k = 0; k < 4; ++k) {
          a[lane][k] = RegisterOfA(inputs[lane].first, part, k);
        }
        for (int k = 0; k < 2; ++k) {
          b[lane][k] = RegisterOfB(weights[lane], part, k);
        }
      }
      MultiplyByTheManual(a, b, expected);
    }
    HostWarp::multiplyAdd(inputs, weights, half, sums);
    for (int lane = 0; lane < WarpSize; ++lane) {
      for (int v = 0; v < 4; ++v) { // of C: as above
        EXPECT_EQ(sums[lane].values[4 * half + v],
                  expected[(lane >> 2) + 8 * (v / 2)][2 * (lane & 3) + v % 2])
            << half << " " << lane << " " << v;
      }
    }
  }
}

TEST(Tiles, AreLoadedFromRows)
{
  constexpr int stride = TileSize + 8;
  alignas(16) HalfBits rows[TileSize * stride] = {};
  for (int row = 0; row < TileSize; ++row) {
    for (int column = 0; column < TileSize; ++column) {
      rows[row * stride + column] = ToHalf(Small(3, row, column));
    }
  }
  for (int lane = 0; lane < WarpSize; ++lane) {
    const InputShare expected = InputsOf(3, lane);
    const InputShare loaded = LoadInputs(rows, stride, lane);
    for (int r = 0; r < 4; ++r) {
      EXPECT_EQ(loaded.pairs[r], expected.pairs[r]) << lane << " " << r;
    }
  }
}

/// Sums of a layer are, lane by lane, the inputs of the next.
TEST(Tiles, ResultsBecomeInputs)
{
  HostWarp warp(0, false);
  HostWarp::PerLane<SumShare> sums[1][1];
  for (int lane = 0; lane < WarpSize; ++lane) {
    const int group = lane >> 2;
    const int thread = lane & 3;
    for (int v = 0; v < 8; ++v) {
      sums[0][0][lane].values[v] =
          Small(4, group + (v % 4 >= 2 ? 8 : 0), 2 * thread + (v & 1) + (v >= 4 ? 8 : 0));
    }
  }
  KeptInputs<HalfNumbers, 1, 1, HostWarp> kept(warp);
  kept.take(inr::Activation::None, sums);
  kept.forEachTile(1, [&](int, const auto& ofHalf) {
    for (int lane = 0; lane < WarpSize; ++lane) {
      const InputShare expected = InputsOf(4, lane);
      for (int r = 0; r < 4; ++r) {
        EXPECT_EQ(ofHalf(0)[lane].pairs[r], expected.pairs[r]) << lane << " " << r;
      }
    }
  });
}

} // namespace test::tiles
