// SPDX-License-Identifier: BSD-3-Clause
//
// Bricks of random voxels, ways through them, and what is there in double precision.
#pragma once

#include "Core/Random.h"
#include "Core/Render/Bricks/BrickKernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace test::kernel_bricks {

constexpr int Dims[3] = {7, 6, 5};
constexpr int Bricks = 4;
constexpr int BlockEdge = 2; // of 3 x 3 x 2 blocks

struct Voxels
{
  inr::BrickFormat format;
  std::vector<unsigned char> bytes;
  std::vector<double> values; ///< as they are stored
  int perBrick = Dims[0] * Dims[1] * Dims[2];
};

inline Voxels MakeVoxels(inr::VoxelBytes bytes)
{
  Voxels voxels;
  voxels.format = {bytes,
                   Dims[0],
                   Dims[0] * Dims[1],
                   {Dims[0] - 2, Dims[1] - 2, Dims[2] - 2},
                   1.0f / BlockEdge,
                   {2, 2, 1}};
  const auto size = static_cast<std::size_t>(bytes);
  voxels.bytes.resize(static_cast<std::size_t>(Bricks * voxels.perBrick) * size + 64);
  for (int k = 0; k < Bricks * voxels.perBrick; ++k) {
    const float value = inr::RandomUnit(1, static_cast<std::uint64_t>(k));
    const auto word =
        static_cast<std::uint32_t>(value * std::ldexp(1.0f, 8 * static_cast<int>(size % 4)));
    unsigned char* to = voxels.bytes.data() + static_cast<std::size_t>(k) * size;
    if (bytes == inr::VoxelBytes::Four) {
      std::memcpy(to, &value, size);
      voxels.values.push_back(value);
    } else {
      std::memcpy(to, &word, size); // little endian, as all that kernels are built for
      voxels.values.push_back(word);
    }
  }
  return voxels;
}

inline float Random(float low, float high)
{
  static std::uint64_t counter = 0;
  return low + (high - low) * inr::RandomUnit(2, ++counter);
}

inline int RandomInt(int low, int high)
{
  return static_cast<int>(Random(0, 0.9999f) * static_cast<float>(high - low + 1)) + low;
}

inline inr::BrickPath RandomPath(const Voxels& voxels)
{
  inr::BrickPath path;
  const int brick = RandomInt(0, Bricks - 1);
  path.voxels = voxels.bytes.data() + static_cast<std::size_t>(brick * voxels.perBrick) *
                                          static_cast<std::size_t>(voxels.format.bytes);
  path.base = Random(-1, 1);
  path.quantum = voxels.format.bytes == inr::VoxelBytes::Four ? 1.0f : Random(0, 1e-3f);
  for (int axis = 0; axis < 3; ++axis) {
    path.origin[axis] = Random(-1, 5);
    path.direction[axis] = Random(-0.1f, 0.2f);
    path.last[axis] = static_cast<float>(RandomInt(1, Dims[axis] - 1));
  }
  return path;
}

inline double Trilinear(const Voxels& voxels, const inr::BrickPath& path, double along)
{
  const auto offset = static_cast<const unsigned char*>(path.voxels) - voxels.bytes.data();
  const auto first = static_cast<int>(offset) / static_cast<int>(voxels.format.bytes);
  int cell[3];
  double weight[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double place =
        std::clamp<double>(path.origin[axis] + along * path.direction[axis], 0, path.last[axis]);
    cell[axis] = std::min(static_cast<int>(place), Dims[axis] - 2);
    weight[axis] = place - cell[axis];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double share = 1;
    int at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int up = corner >> axis & 1;
      at[axis] = cell[axis] + up;
      share *= up != 0 ? weight[axis] : 1 - weight[axis];
    }
    const int index = at[0] + Dims[0] * (at[1] + Dims[1] * at[2]);
    sum += share * voxels.values[static_cast<std::size_t>(first + index)];
  }
  return path.base + path.quantum * sum;
}

} // namespace test::kernel_bricks
