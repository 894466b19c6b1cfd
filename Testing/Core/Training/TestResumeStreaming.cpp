// SPDX-License-Identifier: BSD-3-Clause
//
// Trainings from pieces that go on from a checkpoint: what was read once is not read again.
#include "Core/Error.h"
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/FakeTrainer.h"
#include "Testing/Core/Training/FieldReader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

namespace test::resume_streaming {

using inr::CheckpointEvent;

constexpr std::int64_t MiB = std::int64_t{1} << 20;
constexpr double Blocks = 64;

/// Of a source with so many other arrays that the volume makes many blocks.
class WideReader : public FieldReader<float>
{
public:
  using FieldReader<float>::FieldReader;
  std::int64_t bytesPerVoxel() const override { return 512; }
};

class ResumeStreaming : public testing::Test
{
protected:
  ResumeStreaming()
  {
    this->Options.description = SmallDescription();
    this->Options.storedAs = inr::ParameterType::Half;
    this->Options.memoryLimit = 124 * MiB;
    this->Options.checkpoint.path = this->Path;
    this->Options.checkpoint.interval = 0;
    this->Options.checkpoint.tell = [this](CheckpointEvent event, const std::string& text) {
      this->Resumed += event == CheckpointEvent::Resumed ? 1 : 0;
      this->Ignored += event == CheckpointEvent::Ignored ? 1 : 0;
      this->Warning = event == CheckpointEvent::Ignored ? text : this->Warning;
    };
  }

  /// As long as `observer` says. The model, or none and what the error says.
  inr::ModelPointer train(const inr::TrainingObserver& observer = {})
  {
    WideReader reader(this->Data);
    reader.before = this->Before;
    this->Warning.clear();
    this->Resumed = 0;
    this->Ignored = 0;
    this->Surveyed = false;
    inr::ModelPointer model;
    try {
      model = inr::TrainModel(reader, {}, this->Options, [&](const inr::TrainingProgress& now) {
        this->Surveyed |= now.phase == inr::TrainingPhase::Reading;
        return !observer || observer(now);
      });
    } catch (const inr::Error& error) {
      this->Warning = error.what();
    }
    this->Read =
        static_cast<double>(reader.voxelsRead) / static_cast<double>(this->Data.data().voxels());
    return model;
  }

  void stopAfter(std::uint64_t steps)
  {
    EXPECT_FALSE(this->train([&](const inr::TrainingProgress& now) { return now.steps < steps; }));
    EXPECT_NE(this->Warning.find("kept"), std::string::npos) << this->Warning;
  }

  inr::ModelPointer trainWithoutCheckpoint()
  {
    this->Options.checkpoint.path.clear();
    const inr::ModelPointer model = this->train();
    this->Options.checkpoint.path = this->Path;
    return model;
  }

  void expectModelOf(const inr::ModelPointer& other, const inr::ModelPointer& model)
  {
    ASSERT_TRUE(model) << this->Warning;
    EXPECT_EQ(model->parameters, other->parameters);
    EXPECT_EQ(model->volume.low, other->volume.low);
    EXPECT_EQ(model->volume.high, other->volume.high);
    EXPECT_EQ(model->training->nonFinite, other->training->nonFinite);
    EXPECT_EQ(model->training->plannedSteps, other->training->plannedSteps);
    EXPECT_EQ(model->quality->psnr, other->quality->psnr);
    for (std::size_t k = 0; k < other->macroCells.ranges.size(); ++k) {
      ASSERT_EQ(model->macroCells.ranges[k].low, other->macroCells.ranges[k].low);
      ASSERT_EQ(model->macroCells.ranges[k].high, other->macroCells.ranges[k].high);
    }
  }

  TemporaryFolder Folder;
  std::string Path = Folder.file("a.inr.checkpoint");
  inr::TrainingOptions Options = Steps(40);
  Field<float> Data = WaveField<float>({64, 70, 77}, inr::ScalarType::Float32, -3, 5);
  std::function<void(int)> Before;

  double Read = 0; ///< times the volume, in the last training
  int Resumed = 0;
  int Ignored = 0;
  bool Surveyed = false;
  std::string Warning;
};

// Once for the range and the samples, once while it trains, once for the quality; and at each going
// on some blocks to see whether the data are the same, and those that were read but not used yet.
TEST_F(ResumeStreaming, ReadsNothingTwice)
{
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  const double once = this->Read;
  EXPECT_GT(once, 2.5);
  EXPECT_LE(once, 3.0);
  double all = 0;
  for (const std::uint64_t steps : {3u, 18u, 25u, 33u}) {
    this->stopAfter(steps);
    EXPECT_EQ(this->Resumed, steps == 3 ? 0 : 1);
    EXPECT_EQ(this->Surveyed, steps == 3);
    all += this->Read;
  }
  this->expectModelOf(whole, this->train());
  EXPECT_EQ(this->Resumed, 1);
  all += this->Read;
  EXPECT_GE(all, once);
  constexpr double looks = 4;
  constexpr double ahead = 5;
  constexpr double borders = 1.4; // of voxels that two blocks need
  EXPECT_LE(all, once + 4 * (looks + ahead) / Blocks * borders);
}

// What is lost when the process is killed is what was read, too.
TEST_F(ResumeStreaming, KeepsWhatTookLongToReadAtOnce)
{
  this->Options.checkpoint.interval = 2;
  this->Options.maximumSteps = 1;
  EXPECT_TRUE(this->train());
  EXPECT_FALSE(std::filesystem::exists(this->Path));
  this->Before = [](int number) {
    std::this_thread::sleep_for(std::chrono::milliseconds(number == 1 ? 2100 : 0));
  };
  EXPECT_TRUE(this->train());
  EXPECT_TRUE(std::filesystem::exists(this->Path));
}

TEST_F(ResumeStreaming, ReadsOnlyForTheQualityWhenAllStepsAreDone)
{
  this->Options.measuredVoxels = std::int64_t{1} << 16; // macro-cells come from the first reading
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  EXPECT_FALSE(this->train(
      [](const inr::TrainingProgress& now) { return now.phase != inr::TrainingPhase::Measuring; }));
  this->expectModelOf(whole, this->train());
  EXPECT_FALSE(this->Surveyed);
  EXPECT_LT(this->Read, 0.4);
}

// Of a training that was too short for a checkpoint.
TEST_F(ResumeStreaming, KeepsAllStepsWhenTheReaderFailsBehindThem)
{
  this->Options.checkpoint.interval = 3600;
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  bool measuring = false;
  this->Before = [&](int) {
    measuring ? throw inr::Error(inr::ErrorCode::CannotRead, "the disk is on fire") : void();
  };
  EXPECT_FALSE(this->train([&](const inr::TrainingProgress& now) {
    measuring = now.phase == inr::TrainingPhase::Measuring;
    return true;
  }));
  EXPECT_NE(this->Warning.find("on fire; its 40 steps are kept"), std::string::npos)
      << this->Warning;
  this->Before = {};
  this->expectModelOf(whole, this->train());
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_FALSE(this->Surveyed);
}

// While the last step is taken, which does not need what is read ahead of it.
TEST_F(ResumeStreaming, KeepsAllStepsWhenTheReaderFailsBesideTheLast)
{
  this->Options.checkpoint.interval = 3600;
  this->Options.maximumSteps = 3;
  constexpr int failing = static_cast<int>(Blocks) + 18 + 1; // 18 are read again by then
  this->Before = [&](int number) {
    if (number == failing) {
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      throw inr::Error(inr::ErrorCode::CannotRead, "the disk is on fire");
    }
  };
  EXPECT_FALSE(this->train());
  EXPECT_NE(this->Warning.find("on fire; its 3 steps are kept"), std::string::npos)
      << this->Warning;
  this->Before = {};
  EXPECT_TRUE(this->train());
  EXPECT_EQ(this->Resumed, 1);
}

// The same size and range, and the same values nearly everywhere.
TEST_F(ResumeStreaming, BeginsAnewWhenTheDataHaveChanged)
{
  this->stopAfter(10);
  std::reverse(this->Data.values.begin(), this->Data.values.end());
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  this->expectModelOf(whole, this->train());
  EXPECT_EQ(this->Resumed, 0);
  EXPECT_TRUE(this->Surveyed);
  EXPECT_NE(this->Warning.find("random voxels"), std::string::npos) << this->Warning;
  EXPECT_TRUE(std::filesystem::exists(this->Path + ".other"));
}

// After the look at some blocks: what is read again is compared, too.
TEST_F(ResumeStreaming, SaysWhenTheDataChangeWithinTheirRange)
{
  this->stopAfter(10);
  this->Before = [&](int number) {
    if (number == 5) {
      std::reverse(this->Data.values.begin(), this->Data.values.end());
    }
  };
  EXPECT_FALSE(this->train());
  EXPECT_NE(this->Warning.find("the data changed after they were first read"), std::string::npos)
      << this->Warning;
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_FALSE(this->Surveyed);
}

TEST_F(ResumeStreaming, BeginsAnewFromABrokenFile)
{
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  this->stopAfter(25);
  std::string bytes = ReadBytes(this->Path);
  for (const std::size_t at : {bytes.size() / 2, bytes.size() - 9}) { // its survey, its parameters
    bytes[at] ^= 4;
    WriteBytes(this->Path, bytes);
    this->expectModelOf(whole, this->train());
    bytes[at] ^= 4;
    EXPECT_TRUE(this->Surveyed);
  }
}

// Those of the version before tell nothing of the data: they are read again, to the same end.
TEST_F(ResumeStreaming, ReadsAgainForACheckpointWithoutASurvey)
{
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  this->stopAfter(25);
  const inr::Arena threads(1);
  inr::GradientDescent descent(SmallDescription(), 1, inr::ChooseInstructionSet(""), threads);
  const inr::CheckpointFile file(this->Path);
  ASSERT_TRUE(file.hasSurvey());
  file.load(descent.state());
  inr::WriteCheckpoint(this->Path, file.identity(), file.state(), descent.state());
  this->expectModelOf(whole, this->train());
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_TRUE(this->Surveyed);
}

// Where another size of macro-cells is wanted, the ranges have to be found again.
TEST_F(ResumeStreaming, ReadsAgainForOtherMacroCells)
{
  this->Options.measuredVoxels = std::int64_t{1} << 16;
  this->stopAfter(25);
  this->Options.macroCellSize = 32;
  const inr::ModelPointer model = this->train();
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_TRUE(this->Surveyed);
  this->expectModelOf(this->trainWithoutCheckpoint(), model);
}

TEST_F(ResumeStreaming, ReadsNothingTwiceForAnAcceleratorEither)
{
  FakeTrainingDevice device;
  device.planned = this->Options.maximumSteps;
  this->Options.acceleration.accelerator = std::make_shared<FakeTrainer>(device);
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  this->stopAfter(25);
  this->expectModelOf(whole, this->train());
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_FALSE(this->Surveyed);
}

// As on a login node first, and then where there is a GPU: nothing says so but the training itself.
TEST_F(ResumeStreaming, BeginsAnewWhereSomethingElseTrains)
{
  FakeTrainingDevice device;
  device.planned = this->Options.maximumSteps;
  const auto accelerator = std::make_shared<FakeTrainer>(device);
  for (const bool accelerated : {true, false}) {
    SCOPED_TRACE(accelerated);
    this->Options.acceleration.accelerator = accelerated ? nullptr : accelerator;
    std::filesystem::remove(this->Path);
    this->stopAfter(25);
    this->Options.acceleration.accelerator = accelerated ? accelerator : nullptr;
    const inr::ModelPointer whole = this->trainWithoutCheckpoint();
    this->expectModelOf(whole, this->train());
    EXPECT_TRUE(this->Surveyed);
    EXPECT_EQ(this->Resumed, 0);
    EXPECT_EQ(this->Ignored, 1);
    EXPECT_NE(this->Warning.find("the kernel family"), std::string::npos) << this->Warning;
    EXPECT_TRUE(std::filesystem::remove(this->Path + ".other"));
  }
}

TEST_F(ResumeStreaming, IsNoneOfOtherSettings)
{
  this->stopAfter(25);
  this->Options.maximumSteps = 41;
  const inr::ModelPointer whole = this->trainWithoutCheckpoint();
  this->expectModelOf(whole, this->train());
  EXPECT_TRUE(this->Surveyed);
  EXPECT_EQ(this->Resumed, 0);
  EXPECT_NE(this->Warning.find("MaximumSteps is 40 there and 41 here"), std::string::npos)
      << this->Warning;
}

} // namespace test::resume_streaming
