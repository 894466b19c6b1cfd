// SPDX-License-Identifier: BSD-3-Clause
//
// Trainings by an accelerator that computes what Core does: whatever happens to it, the model is
// the CPU's, to the last bit (or as good, where it is lost while a volume in storage is read
// again).
#include "Core/Error.h"
#include "Core/Training/Parallel/ParallelTraining.h"
#include "Core/Training/Streaming/StreamBudget.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/FewSteps.h"
#include "Testing/Core/Training/FieldReader.h"
#include "Testing/Core/Training/Fields.h"
#include "Testing/Core/Training/ThreadGroup.h"

#include <gtest/gtest.h>

#include <thread>

namespace test::accelerated_training {

using inr::AccelerationEvent;
using inr::TrainingPipeline;

class Accelerated : public testing::Test
{
protected:
  inr::TrainingOptions options(std::uint64_t steps)
  {
    inr::TrainingOptions options = Steps(steps);
    options.description = TinyDescription();
    options.storedAs = inr::ParameterType::Half;
    this->Device.planned = steps;
    return options;
  }

  inr::TrainingOptions accelerated(std::uint64_t steps)
  {
    inr::TrainingOptions options = this->options(steps);
    options.acceleration.accelerator = std::make_shared<FakeTrainer>(this->Device);
    options.acceleration.tell = [this](AccelerationEvent event, const std::string& text) {
      this->Events.push_back(event);
      this->Texts.push_back(text);
    };
    return options;
  }

  inr::ModelPointer train(const inr::TrainingOptions& options)
  {
    this->Events.clear();
    this->Texts.clear();
    this->Device.calls = 0;
    this->Device.steps = 0;
    return inr::TrainModel(this->Data.data(), {}, options);
  }

  inr::ModelPointer read(const inr::TrainingOptions& options)
  {
    FieldReader<float> reader(this->Data);
    inr::TrainingOptions limited = options;
    limited.memoryLimit = std::int64_t{256} << 20;
    return inr::TrainModel(reader, {}, limited);
  }

  static std::string cpu() { return inr::InstructionSetName(inr::ChooseInstructionSet("")); }

  FakeTrainingDevice Device;
  Field<float> Data = WaveField();
  std::vector<AccelerationEvent> Events;
  std::vector<std::string> Texts;
};

TEST_F(Accelerated, GivesTheModelOfTheCpu)
{
  const inr::ModelPointer expected = this->train(this->options(8));
  EXPECT_EQ(expected->training->backend, "CPU " + cpu());
  EXPECT_EQ(expected->training->pipeline, TrainingPipeline::HostMemory);
  for (const bool hasRoom : {true, false}) {
    this->Device.hasRoom = hasRoom;
    const inr::ModelPointer model = this->train(this->accelerated(8));
    EXPECT_EQ(model->parameters, expected->parameters);
    EXPECT_EQ(model->training->steps, 8u);
    EXPECT_EQ(this->Device.steps, 8);
    EXPECT_EQ(model->training->backend, "Fake device");
    EXPECT_EQ(model->training->kernel, "fake");
    EXPECT_EQ(model->training->pipeline,
              hasRoom ? TrainingPipeline::DeviceMemory : TrainingPipeline::HostMemory);
    EXPECT_TRUE(this->Texts.empty());
  }
}

TEST_F(Accelerated, TrainsFromStorage)
{
  const inr::ModelPointer expected = this->read(this->options(12));
  EXPECT_EQ(expected->training->pipeline, TrainingPipeline::Storage);
  const inr::ModelPointer model = this->read(this->accelerated(12));
  EXPECT_EQ(model->parameters, expected->parameters);
  EXPECT_EQ(model->training->backend, "Fake device");
  EXPECT_EQ(model->training->pipeline, TrainingPipeline::Storage);
}

TEST_F(Accelerated, TheCpuGoesOnWhereverTheDeviceIsLost)
{
  const inr::ModelPointer expected = this->train(this->options(6));
  for (const bool hasRoom : {true, false}) {
    this->Device.hasRoom = hasRoom;
    this->Device.failsAt = FakeTrainingDevice::Never;
    this->train(this->accelerated(6));
    const int calls = this->Device.calls;
    ASSERT_GT(calls, 12);
    for (int k = 0; k <= calls; ++k) {
      this->Device.failsAt = k;
      const inr::ModelPointer model = this->train(this->accelerated(6));
      EXPECT_EQ(model->parameters, expected->parameters) << k;
      EXPECT_EQ(model->training->steps, 6u) << k;
      EXPECT_EQ(this->Texts.size(), k < calls ? 1u : 0u) << k;
      EXPECT_EQ(this->Device.calls, std::min(k + 1, calls))
          << "asked again after it failed at " << k;
      if (k < calls) {
        EXPECT_EQ(this->Events[0], k == 0 ? AccelerationEvent::NotUsed : AccelerationEvent::Failed);
        EXPECT_NE(this->Texts[0].find("the fake device is lost"), std::string::npos);
      }
    }
  }
}

/// Where the steps that are taken again see blocks that were read again meanwhile.
TEST_F(Accelerated, TheCpuGoesOnAsWellFromStorage)
{
  const inr::ModelPointer expected = this->read(this->options(12));
  const auto lostAt = [this](int call) {
    this->Texts.clear();
    this->Device.calls = 0;
    this->Device.failsAt = call;
    return this->read(this->accelerated(12));
  };
  lostAt(FakeTrainingDevice::Never);
  const int calls = this->Device.calls;
  ASSERT_GT(calls, 12);
  for (int k = 0; k < calls; k += 3) {
    const inr::ModelPointer model = lostAt(k);
    EXPECT_EQ(model->training->steps, 12u) << k;
    EXPECT_EQ(this->Texts.size(), 1u) << k;
    EXPECT_NEAR(model->quality->psnr, expected->quality->psnr, 0.5) << k;
  }
}

TEST_F(Accelerated, WhatTrainedIsOnRecord)
{
  this->Device.failsAt = 0;
  const inr::ModelPointer never = this->train(this->accelerated(6));
  EXPECT_EQ(never->training->backend, "CPU " + cpu());
  EXPECT_EQ(never->training->kernel, cpu());
  EXPECT_EQ(never->training->pipeline, TrainingPipeline::HostMemory);
  this->Device.failsAt = 8;
  const inr::ModelPointer some = this->train(this->accelerated(6));
  EXPECT_EQ(some->training->backend, "Fake device, then CPU " + cpu());
  EXPECT_EQ(some->training->kernel, "fake, then " + cpu());
}

/// The first step is compared: its loss, the network's weights, the grid's features.
TEST_F(Accelerated, OneThatGivesOtherValuesIsGivenUp)
{
  const inr::ModelPointer expected = this->train(this->options(5));
  const inr::Layout layout(TinyDescription());
  const std::pair<std::size_t, std::size_t> parts[] = {
      {0, 0}, {0, layout.gridOffset / 2}, {layout.gridOffset, layout.parameterCount}};
  for (const auto& [begin, end] : parts) {
    this->Device.wrongLoss = end == 0 ? 0.01f : 0.0f;
    this->Device.wrongBegin = begin;
    this->Device.wrongEnd = end;
    const inr::ModelPointer model = this->train(this->accelerated(5));
    ASSERT_EQ(this->Events, std::vector<AccelerationEvent>(1, AccelerationEvent::Failed)) << end;
    EXPECT_NE(this->Texts[0].find("its first step is another one"), std::string::npos);
    EXPECT_EQ(this->Device.steps, 1);
    EXPECT_EQ(model->training->steps, 5u);
    EXPECT_EQ(model->parameters, expected->parameters);
    EXPECT_EQ(model->training->backend, "CPU " + cpu());
  }
}

TEST_F(Accelerated, EndsAtTheSameStepByQuality)
{
  inr::TrainingOptions options = this->options(2000);
  options.targetPsnr = 18;
  const inr::ModelPointer expected = this->train(options);
  ASSERT_LT(expected->training->steps, 2000u);
  inr::TrainingOptions other = this->accelerated(2000);
  other.targetPsnr = 18;
  const inr::ModelPointer model = this->train(other);
  EXPECT_EQ(model->training->steps, expected->training->steps);
  EXPECT_EQ(model->parameters, expected->parameters);
}

/// A device that takes long for its first step only is expected to take as many as it will.
TEST_F(Accelerated, IsPlannedByWhatComesAfterItsFirstStep)
{
  inr::TrainingOptions options = this->accelerated(0);
  options.timeLimit = 1.5;
  this->Device.slowStart = 0.3; // in which the plan would be made: of five steps
  this->Device.slowness = 0.01;
  const inr::ModelPointer model = this->train(options);
  EXPECT_GT(model->training->plannedSteps, 10u); // a busy machine adds to the slowness
  EXPECT_LT(model->training->plannedSteps, 300u);
}

TEST_F(Accelerated, ItsProgressSaysSo)
{
  inr::TrainingOptions options = this->accelerated(6);
  this->Device.failsAt = 9;
  int by = 0;
  int without = 0;
  inr::TrainModel(this->Data.data(), {}, options, [&](const inr::TrainingProgress& now) {
    if (now.phase == inr::TrainingPhase::Training) {
      (now.accelerated ? by : without) += 1;
      EXPECT_EQ(now.pipeline, TrainingPipeline::DeviceMemory);
    }
    return true;
  });
  EXPECT_GT(by, 1);
  EXPECT_GT(without, 1);
}

TEST_F(Accelerated, SeveralProcessesTrainWithout)
{
  constexpr int size = 2;
  Meeting meeting(size);
  inr::TrainingOptions options = this->accelerated(4);
  options.acceleration.tell = {};
  std::vector<std::thread> threads;
  std::atomic<int> told{0};
  std::vector<inr::ModelPointer> models(size);
  for (int rank = 0; rank < size; ++rank) {
    threads.emplace_back([&, rank] {
      inr::TrainingOptions own = options;
      own.threads = 1;
      own.acceleration.tell = [&](AccelerationEvent event, const std::string& text) {
        EXPECT_EQ(event, AccelerationEvent::NotUsed);
        EXPECT_NE(text.find("several processes"), std::string::npos);
        ++told;
      };
      const ThreadGroup group(meeting, rank, size);
      inr::VolumeInfo info;
      info.dims = this->Data.dims;
      models[static_cast<std::size_t>(rank)] =
          inr::TrainModel(inr::VolumePiece{this->Data.data(), glm::i64vec3(0)}, info, own, group);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(told, size);
  EXPECT_EQ(this->Device.calls, 0);
  EXPECT_EQ(models[0]->training->backend, "CPU " + cpu());
}

class AcceleratedResume : public Accelerated
{
protected:
  inr::TrainingOptions with(inr::TrainingOptions options)
  {
    options.checkpoint.path = this->Path;
    options.checkpoint.tell = [this](inr::CheckpointEvent event, const std::string&) {
      this->Resumed += event == inr::CheckpointEvent::Resumed ? 1 : 0;
    };
    return options;
  }

  void stopAfter(std::uint64_t steps, const inr::TrainingOptions& options)
  {
    EXPECT_THROW(
        inr::TrainModel(this->Data.data(), {}, options,
                        [&](const inr::TrainingProgress& now) { return now.steps < steps; }),
        inr::Error);
  }

  TemporaryFolder Folder;
  std::string Path = Folder.file("a.inr.checkpoint");
  int Resumed = 0;
};

/// Where the device computes what the CPU does, each goes on from the other's checkpoint.
TEST_F(AcceleratedResume, CheckpointsAreOfOneForm)
{
  this->Device.kernel = cpu();
  const inr::ModelPointer whole = this->train(this->options(12));
  this->stopAfter(4, this->with(this->accelerated(12)));
  this->stopAfter(8, this->with(this->options(12)));
  const inr::ModelPointer resumed = this->train(this->with(this->accelerated(12)));
  EXPECT_EQ(this->Resumed, 2);
  EXPECT_EQ(this->Device.steps, 12 - 8);
  EXPECT_EQ(resumed->parameters, whole->parameters);
  EXPECT_EQ(resumed->training->steps, 12u);
}

TEST_F(AcceleratedResume, TheCheckpointIsOfTheStepsThatAreSafe)
{
  const inr::ModelPointer whole = this->train(this->options(12));
  this->Device.calls = 0;
  this->Device.failsAt = 11; // in the fifth step, or so
  this->stopAfter(6, this->with(this->accelerated(12)));
  this->Device.failsAt = FakeTrainingDevice::Never;
  const inr::ModelPointer resumed = this->train(this->with(this->accelerated(12)));
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_EQ(resumed->parameters, whole->parameters);
}

/// The device is lost when the checkpoint asks it for its steps.
TEST_F(AcceleratedResume, ALostDeviceLeavesTheStepsBefore)
{
  const inr::ModelPointer whole = this->train(this->options(12));
  this->Device.calls = 0;
  inr::TrainingOptions options = this->with(this->accelerated(12));
  EXPECT_THROW(inr::TrainModel(this->Data.data(), {}, options,
                               [&](const inr::TrainingProgress& now) {
                                 if (now.steps == 5) {
                                   this->Device.failsAt = this->Device.calls;
                                 }
                                 return now.steps < 5;
                               }),
               inr::Error);
  this->Device.failsAt = FakeTrainingDevice::Never;
  const inr::ModelPointer resumed = this->train(this->with(this->accelerated(12)));
  EXPECT_EQ(this->Resumed, 1);
  EXPECT_EQ(this->Device.steps, 12 - 1); // the copy is of the first step
  EXPECT_EQ(resumed->parameters, whole->parameters);
}

TEST(AcceleratedMemory, IsReckonedWith)
{
  const inr::Description description = SmallDescription();
  const auto parameters = static_cast<std::int64_t>(inr::Layout(description).parameterCount);
  EXPECT_EQ(inr::TrainingBytes(description, true) - inr::TrainingBytes(description),
            14 * parameters);
}

} // namespace test::accelerated_training
