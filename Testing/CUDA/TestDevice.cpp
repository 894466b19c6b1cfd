// SPDX-License-Identifier: BSD-3-Clause
//
// What is said of GPUs and of models that they cannot have.
#include "CUDA/Inference/Kernels/BrickInputs.h"
#include "CUDA/Inference/PackedModel.h"
#include "CUDA/Render/Renderers.h"
#include "Core/Error.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

namespace test::device {

using namespace inr::cuda;

/// The message of what `call` throws with this code.
template <class Call> std::string Refusal(inr::ErrorCode code, const Call& call)
{
  try {
    call();
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "";
}

TEST(Device, WhatIsNotUsedHasAReason)
{
  const Devices devices = FindDevices();
  EXPECT_FALSE(devices.usable.empty() && devices.reason.empty());
  for (const inr::cuda::Device& device : devices.usable) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_GE(10 * device.major + device.minor, 75);
    EXPECT_GT(device.multiprocessors, 0);
    EXPECT_GE(device.sharedPerBlock, 48 << 10);
    EXPECT_GT(device.memory, 1 << 28);
  }
}

TEST(Device, RunsCodeForItsGenerationAndWhatTheDriverTranslates)
{
  const std::string one = "80-real 80-virtual";
  EXPECT_EQ(CodeFor(one, 75), 0);
  for (const int capability : {80, 86, 90, 121}) {
    EXPECT_EQ(CodeFor(one, capability), 80) << capability;
  }
  const std::string two = "75-real 86-real 90-real";
  for (const auto& [capability, code] :
       {std::pair(75, 75), {86, 86}, {89, 86}, {90, 90}, {70, 0}, {80, 0}, {100, 0}, {120, 0}}) {
    EXPECT_EQ(CodeFor(two, capability), code) << capability;
  }
  // What the driver translates is code for what it was made for, wherever it runs.
  EXPECT_EQ(CodeFor("75-real 75-virtual", 80), 75);
  EXPECT_EQ(CodeFor("90-virtual 75-virtual 80-real", 89), 80);
  EXPECT_EQ(CodeFor("90-virtual 75-virtual 80-real", 100), 90);
  EXPECT_EQ(CodeFor("80-real 86-virtual", 89), 80);
}

TEST(Device, WithoutOneTheReasonIsThrown)
{
  const Devices devices = FindDevices();
  if (!devices.usable.empty()) {
    GTEST_SKIP() << "there is a GPU";
  }
  EXPECT_EQ(Refusal(inr::ErrorCode::Device, [] { ChooseDevice(); }), devices.reason);
  EXPECT_NE(Refusal(inr::ErrorCode::Device,
                    [] { UploadModel(RandomModel(SmallDescription()), {}, Precision::Half); }),
            "");
}

TEST(Device, ProcessesOfAMachineShareItsGpus)
{
  Devices devices;
  EXPECT_EQ(devices.of(0), nullptr);
  for (int ordinal = 1; ordinal < 4; ++ordinal) { // one that is left out
    devices.usable.emplace_back().ordinal = ordinal;
  }
  for (int rank = 0; rank < 7; ++rank) {
    EXPECT_EQ(devices.of(rank)->ordinal, 1 + rank % 3);
  }
}

TEST(HalfPrecision, IsRefusedForWhatItCannotHold)
{
  auto model = RandomModel(SmallDescription());
  EXPECT_EQ(WhyNotHalf(*model), "");
  model->parameters[5] = -65505.0f;
  EXPECT_NE(WhyNotHalf(*model).find("parameter 5 is -65505"), std::string::npos);
  inr::Description wide = SmallDescription();
  wide.network.neurons = 129;
  EXPECT_NE(WhyNotHalf(*RandomModel(wide)).find("129 neurons"), std::string::npos);
  EXPECT_NE(
      Refusal(inr::ErrorCode::Unsupported, [&] { PackedModel<HalfNumbers>{*RandomModel(wide)}; }),
      "");
  wide.network.hiddenLayers = 0; // and so none of them
  EXPECT_EQ(WhyNotHalf(*RandomModel(wide)), "");
}

/// Parts follow each other, aligned, and end where the plan says.
TEST(SharedMemory, IsSharedOutWithinItsLimits)
{
  const PackedModel<HalfNumbers> model(*RandomModel(SmallDescription()));
  const auto weights = static_cast<std::int32_t>(model.weights.size() * sizeof(WeightShare));
  for (const bool bricks : {false, true}) {
    for (const std::int64_t roomy : {4 << 10, 16 << 10, 28 << 10, 48 << 10, 100 << 10}) {
      const FusedShared plan = PlanShared(model, bricks, roomy, 100 << 10);
      EXPECT_EQ(plan.rows, plan.keepsWeights ? weights : 0);
      EXPECT_EQ(plan.results, plan.rows + (bricks ? 0 : 128 * 24 * 2));
      EXPECT_EQ(plan.coordinates, plan.results + 4 * (bricks ? 512 : 128));
      EXPECT_EQ(plan.parts, plan.coordinates + (bricks ? 3 * 8 * 4 : 0));
      EXPECT_GE(plan.lattice, plan.parts + (bricks ? 4 * (3 * 8 * 8 + 5 * 4) : 0));
      EXPECT_EQ(plan.lattice % 16, 0);
      EXPECT_EQ(plan.mixed, plan.lattice + plan.room.rows * 8 * 4 * 4);
      EXPECT_EQ(plan.end, plan.mixed + 4 * plan.room.ofLayer * 8 * 4 * 4);
      EXPECT_TRUE(plan.end <= roomy || !plan.keepsWeights);
    }
    EXPECT_TRUE(PlanShared(model, bricks, 100 << 10, 100 << 10).keepsWeights);
    EXPECT_FALSE(PlanShared(model, bricks, 7 << 10, 100 << 10).keepsWeights);
  }
  const FusedShared whole = PlanShared(model, true, 100 << 10, 100 << 10);
  EXPECT_EQ(whole.room.rows, (28 << 10) / (8 * 4 * 4));
  EXPECT_EQ(whole.room.ofLayer, whole.room.rows / 4);
}

/// Weights that are halves are whole in their first parts; others are, but for 2^-22, in two.
TEST(WideWeights, AreTheSumOfTheirParts)
{
  for (const bool halves : {true, false}) {
    auto model = RandomModel(SmallDescription());
    for (float& parameter : model->parameters) {
      parameter = halves ? ToFloat(ToHalf(parameter)) : parameter;
    }
    const PackedModel<FloatNumbers> packed(*model);
    EXPECT_EQ(packed.hasSecond, !halves);
    const inr::Layout layout(model->description);
    const inr::LayerShape& shape = layout.layers[0]; // 16 x 16: its tile comes first
    ASSERT_EQ(packed.inputTiles * packed.neuronTiles, 1);
    for (int lane = 0; lane < WarpSize; ++lane) {
      for (int v = 0; v < 8; ++v) {
        const int row = lane / 4 + 8 * (v / 4);
        const int column = lane % 4 * 2 + v % 2 + 8 * (v / 2 % 2);
        const int share = v / 4 * WarpSize + lane; // of the first part
        const float weight = model->parameters[shape.offset + row * shape.columns + column];
        float sum = packed.weights[share].values[v % 4];
        EXPECT_EQ(CutToElevenBits(sum), sum);
        if (!halves) {
          const float second = packed.weights[2 * WarpSize + share].values[v % 4];
          EXPECT_EQ(CutToElevenBits(second), second);
          sum += second;
        }
        EXPECT_NEAR(sum, weight, halves ? 0.0f : std::abs(weight) * 0x1p-22f);
      }
    }
  }
}

TEST(SharedMemory, IsNotEnoughForAnyNumberOfLevels)
{
  inr::Description description = SmallDescription();
  description.grid.levels = 64;
  description.grid.features = 8;
  description.grid.perLevelScale = 1.1f;
  const PackedModel<HalfNumbers> model(*RandomModel(description));
  const std::string refusal =
      Refusal(inr::ErrorCode::Unsupported, [&] { PlanShared(model, false, 48 << 10, 64 << 10); });
  EXPECT_FALSE(FitsShared(model, 64 << 10));
  EXPECT_TRUE(FitsShared(model, 227 << 10));
  EXPECT_NE(refusal.find("64 grid levels"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("65536"), std::string::npos) << refusal;
}

/// Cells that are very far apart are not taken for few.
TEST(Lattice, OfFarCellsIsNotKept)
{
  const float coordinates[3 * ItemSize] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0,
                                           0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
  inr::LevelView level{};
  LevelPart parts[2] = {};
  for (const float scale : {2.0f, 1.0e9f}) {
    level.scale = scale;
    SetExtent(SamplePlaces(coordinates, level, inr::GridInterpolation::Linear), parts[1]);
    SetFirst(parts, 1, {1 << 20, 1 << 20});
    EXPECT_EQ(parts[1].rows <= MostLatticeRows, scale == 2.0f);
    EXPECT_EQ(parts[1].first >= 0, scale == 2.0f);
    for (const RowRoom& room :
         {RowRoom{parts[1].rows - 1, 1 << 20}, {1 << 20, parts[1].down - 1}}) {
      SetFirst(parts, 1, room);
      EXPECT_LT(parts[1].first, 0) << "where there is no room";
    }
  }
}

} // namespace test::device
