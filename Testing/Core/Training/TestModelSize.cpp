// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/ModelFile.h"
#include "Core/Training/Trainer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::model_size {

/// Bytes of volume over bytes of the file that a chosen model would make.
double RatioOf(const glm::i64vec3& dims, inr::ScalarType type, double wanted)
{
  inr::Model model;
  model.description = inr::ChooseDescription(dims, type, wanted);
  model.macroCells = inr::MakeMacroCells(dims, inr::DefaultMacroCellSize(dims));
  const double bytes = static_cast<double>(dims.x) * static_cast<double>(dims.y) *
                       static_cast<double>(dims.z) * static_cast<double>(inr::ScalarSize(type));
  return bytes / static_cast<double>(inr::ModelFileSize(model));
}

TEST(ModelSize, ReachesTheWantedRatioWithoutWastingIt)
{
  for (const double wanted : {8.0, 20.0, 50.0, 200.0}) {
    const double ratio = RatioOf({256, 256, 256}, inr::ScalarType::Float32, wanted);
    EXPECT_GE(ratio, wanted);
    EXPECT_LE(ratio, 1.3 * wanted);
  }
}

// However many levels there are, they reach from the same coarsest to the same finest.
TEST(ModelSize, LevelsReachTheVoxels)
{
  for (const double wanted : {8.0, 14.0, 20.0, 33.0, 50.0, 200.0}) {
    const inr::Description chosen =
        inr::ChooseDescription({256, 256, 256}, inr::ScalarType::Float32, wanted);
    const double finest =
        chosen.grid.baseResolution * std::pow(chosen.grid.perLevelScale, chosen.grid.levels - 1);
    EXPECT_GE(finest, 256) << wanted;
    EXPECT_LE(finest, 1.5 * 256) << wanted;
  }
}

TEST(ModelSize, DefaultGrowsMoreSlowlyThanTheVolume)
{
  const double small = RatioOf({64, 64, 64}, inr::ScalarType::Float32, 0);
  const double medium = RatioOf({256, 256, 256}, inr::ScalarType::Float32, 0);
  const double large = RatioOf({4096, 4096, 4096}, inr::ScalarType::Float32, 0);
  EXPECT_GT(small, 1.9);
  EXPECT_GT(medium, small);
  EXPECT_GT(large, 500);
}

TEST(ModelSize, IsReadableUpstream)
{
  for (const std::int64_t n : {8, 91, 302, 2048}) {
    const inr::Description chosen = inr::ChooseDescription({n, n, n}, inr::ScalarType::UInt8, 0);
    const int widths[] = {16, 32, 64, 128}; // of FullyFusedMLP
    EXPECT_NE(std::find(std::begin(widths), std::end(widths), chosen.network.neurons),
              std::end(widths));
    EXPECT_EQ(chosen.network.alignment, 16);
    EXPECT_EQ(chosen.grid.type, inr::GridType::Hash);
  }
}

} // namespace test::model_size
