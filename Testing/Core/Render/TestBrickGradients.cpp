// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients within bricks, by every kernel, against double precision one sample at a time.
#include "Testing/Core/Kernels.h"
#include "Testing/Core/Render/KernelBricks.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace test::brick_gradients {

using namespace kernel_bricks;

/// By samples one voxel to either side, in double; nothing where one may be beyond a rim.
std::optional<double> Difference(const Voxels& voxels, const inr::BrickPath& path, double along,
                                 int axis)
{
  const double place = path.origin[axis] + along * path.direction[axis];
  if (place < 1 || place >= path.last[axis] - 1) {
    return std::nullopt;
  }
  inr::BrickPath before = path;
  inr::BrickPath behind = path;
  before.origin[axis] -= 1;
  behind.origin[axis] += 1;
  return (Trilinear(voxels, behind, along) - Trilinear(voxels, before, along)) / 2;
}

class BrickGradients : public testing::TestWithParam<std::string>
{};

TEST_P(BrickGradients, AreFoundWhereThereIsNoRim)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  for (const inr::VoxelBytes bytes :
       {inr::VoxelBytes::One, inr::VoxelBytes::Two, inr::VoxelBytes::Four}) {
    const Voxels voxels = MakeVoxels(bytes);
    const auto batch = std::make_unique<inr::SampleBatch>();
    const auto gradients = std::make_unique<inr::GradientBatch>();
    int inside = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const int count = RandomInt(1, inr::SampleBatch::Capacity);
      std::vector<int> which;
      for (int k = 0; k < count; ++k) {
        batch->paths[k] = RandomPath(voxels);
        batch->path[k] = k > 0 && RandomInt(0, 3) > 0 ? batch->path[k - 1] : k;
        batch->along[k] = Random(0, 20);
        if (RandomInt(0, 2) > 0) {
          which.push_back(k);
        }
      }
      if (which.empty()) {
        continue;
      }
      const auto chosen = static_cast<int>(which.size());
      kernel.differentiate(voxels.format, *batch, which.data(), chosen, *gradients);
      for (int k = 0; k < chosen; ++k) {
        const inr::BrickPath& path = batch->paths[batch->path[which[k]]];
        const double steepest = path.quantum * (bytes == inr::VoxelBytes::Four ? 1.0 : 65536.0);
        for (int axis = 0; axis < 3; ++axis) {
          const double along = batch->along[which[k]];
          const std::optional<double> truth = Difference(voxels, path, along, axis);
          const double place = path.origin[axis] + along * path.direction[axis];
          const double fromRim =
              std::min(std::abs(place - 1), std::abs(place - path.last[axis] + 1));
          const bool isInside = (gradients->inside[k] >> axis & 1) != 0;
          EXPECT_TRUE(isInside == truth.has_value() || fromRim < 1e-5) << place;
          if (isInside && truth) {
            ++inside;
            EXPECT_NEAR(gradients->along[axis][k], *truth, 1e-5 * std::max(1.0, steepest));
          }
        }
      }
    }
    EXPECT_GT(inside, 3000);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, BrickGradients, testing::ValuesIn(UsableKernels()),
                         [](const auto& info) { return info.param; });

} // namespace test::brick_gradients
