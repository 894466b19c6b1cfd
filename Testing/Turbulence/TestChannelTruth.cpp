// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Turbulence/ChannelTruth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::channel_truth {

std::shared_ptr<inr::Model> UntrainedModel()
{
  inr::Description description = SmallDescription();
  description.network.outputActivation = inr::Activation::Sigmoid;
  auto model = RandomModel(description);
  model->volume.dims = {20, 12, 9};
  model->volume.low = -0.5;
  model->volume.high = 1.5;
  model->volume.type = inr::ScalarType::Float64;
  return model;
}

// All voxels, one by one.
inr::ChannelError BruteForce(const inr::ModelPointer& model, const inr::TurbulentChannel& field)
{
  const inr::VolumeInfo& volume = model->volume;
  const auto network = inr::MakeEvaluator(model);
  inr::ChannelError error;
  double squared = 0;
  for (std::int64_t z = 0; z < volume.dims.z; ++z) {
    for (std::int64_t y = 0; y < volume.dims.y; ++y) {
      for (std::int64_t x = 0; x < volume.dims.x; ++x) {
        const glm::dvec3 u = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(volume.dims);
        const glm::vec3 position(u);
        float output = 0;
        network->evaluate(&position, 1, &output);
        const double off =
            volume.low + (volume.high - volume.low) * inr::NormalisedOutput(output) - field.at(u);
        squared += off * off;
        error.maxError = std::max(error.maxError, std::abs(off));
        ++error.voxels;
      }
    }
  }
  error.rootMeanSquare = std::sqrt(squared / static_cast<double>(error.voxels));
  error.psnr = 20 * std::log10((volume.high - volume.low) / error.rootMeanSquare);
  return error;
}

TEST(ChannelTruth, RandomVoxelsTellWhatAllVoxelsDo)
{
  const auto model = UntrainedModel();
  const inr::TurbulentChannel field({});
  const inr::ChannelError all = BruteForce(model, field);
  const inr::ChannelError drawn =
      inr::MeasureChannelError(model, field, 200000, 1, inr::Arena(2)); // nearly all are met
  EXPECT_EQ(drawn.voxels, 200000);
  EXPECT_NEAR(drawn.psnr, all.psnr, 0.03);
  EXPECT_NEAR(drawn.maxError, all.maxError, 1e-6);
  EXPECT_NEAR(drawn.rootMeanSquare, all.rootMeanSquare, 0.004 * all.rootMeanSquare);
}

TEST(ChannelTruth, ThreadsDoNotChangeIt)
{
  const auto model = UntrainedModel();
  const inr::TurbulentChannel field({});
  const auto measured = [&](int threads, std::uint64_t seed) {
    return inr::MeasureChannelError(model, field, 50001, seed, inr::Arena(threads)).psnr;
  };
  EXPECT_EQ(measured(1, 1), measured(2, 1));
  EXPECT_NE(measured(1, 1), measured(1, 2));
}

TEST(ChannelTruth, RefusesToCompareNothing)
{
  EXPECT_THROW(
      inr::MeasureChannelError(UntrainedModel(), inr::TurbulentChannel({}), 0, 1, inr::Arena(1)),
      inr::Error);
}

} // namespace test::channel_truth
