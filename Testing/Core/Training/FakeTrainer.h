// SPDX-License-Identifier: BSD-3-Clause
//
// An accelerator for trainings that is none: Core computes, so that its results are the CPU's to
// the last bit. It counts what it is asked for, and fails when it is told to.
#pragma once

#include "Core/Error.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Descent/TrainingAccelerator.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

/// Of a model that takes no time.
inline inr::Description TinyDescription()
{
  inr::Description description = SmallDescription();
  description.grid.levels = 2;
  description.grid.features = 2;
  description.network.neurons = 8;
  description.network.hiddenLayers = 1;
  return description;
}

/// What the test and the trainings of a device know of each other.
struct FakeTrainingDevice
{
  static constexpr int Never = std::numeric_limits<int>::max();

  std::uint64_t planned = 0;   ///< steps of the learning rate; 0 = not known to the test
  double slowStart = 0;        ///< seconds
  double slowness = 0;         ///< seconds that a step takes more
  double seconds = 0;          ///< of a clock that shows
  double stepSeconds = 0;      ///< how long a step took
  double copySeconds = 0;      ///< and a copy of its state
  bool hasRoom = true;         ///< for a volume
  std::string kernel = "fake"; ///< of the training record
  int failsAt = Never;         ///< that call and all that follow fail; 0 = to start
  float wrongLoss = 0;         ///< what is added to it
  std::size_t wrongBegin = 0;  ///< parameters from here on
  std::size_t wrongEnd = 0;    ///< to there are told wrong
  std::size_t stays = 0;       ///< so many parameters do not move
  int calls = 0;               ///< so far
  int gets = 0;                ///< of them
  int steps = 0;

  void call()
  {
    if (this->calls++ >= this->failsAt) {
      throw inr::Error(inr::ErrorCode::Device, "the fake device is lost");
    }
  }
};

class FakeTraining : public inr::AcceleratedTraining
{
public:
  FakeTraining(FakeTrainingDevice& device, const inr::TrainingTask& task)
      : Device(device), Task(task), Threads(1),
        Core(task.description, 1, inr::ChooseInstructionSet(""), this->Threads)
  {
    this->Core.plan(device.planned > 0 ? device.planned : std::uint64_t{1} << 40);
    for (Buffer& buffer : this->Buffers) {
      buffer.positions.resize(static_cast<std::size_t>(task.samples));
      buffer.targets.resize(static_cast<std::size_t>(task.samples));
    }
  }

  bool drawsSamples() const override { return this->Task.volume && this->Device.hasRoom; }

  void put(const inr::StateArrays& state) override
  {
    this->Device.call();
    std::this_thread::sleep_for(std::chrono::duration<double>(this->Device.slowStart));
    copy(state, this->Core.state());
    this->Begin = this->Core.parameters();
  }

  /// One that fails leaves half of them wrong, as a copy that broke off might.
  void get(const inr::StateArrays& state) override
  {
    ++this->Device.gets;
    this->Device.seconds += this->Device.copySeconds;
    for (const inr::StateArray& array : state) {
      std::memset(array.data, 0xff, static_cast<std::size_t>(array.bytes / 2));
    }
    this->Device.call();
    copy(this->Core.state(), state);
    auto* const values = static_cast<float*>(state[0].data);
    for (std::size_t k = this->Device.wrongBegin; k < this->Device.wrongEnd; ++k) {
      values[k] += 0.02f;
    }
    std::copy_n(this->Begin.begin(), this->Device.stays, values);
  }

  Samples samples(int buffer) override
  {
    EXPECT_FALSE(this->drawsSamples());
    Buffer& room = this->Buffers[buffer];
    return {room.positions.data(), room.targets.data()};
  }

  void begin(const Step& step) override
  {
    if (this->Device.planned > 0) {
      EXPECT_EQ(step.learningRate, inr::LearningRate().at(step.number, this->Device.planned));
    }
    this->Device.call();
    this->Begun = step;
  }

  /// Computes now: what was in the buffer when it began is to be there still.
  double finish() override
  {
    this->Device.call();
    ++this->Device.steps;
    this->Device.seconds += this->Device.stepSeconds;
    std::this_thread::sleep_for(std::chrono::duration<double>(this->Device.slowness));
    this->Core.goOnAfter(this->Begun.number);
    const float wrong = this->Device.wrongLoss;
    if (this->drawsSamples()) {
      const inr::NormalisedVolume& volume = *this->Task.volume;
      const inr::InMemorySource source(volume.data, volume.low, volume.high);
      inr::StratifiedBatches batches(source);
      EXPECT_EQ(this->Core.stream(), this->Task.stream) << "the test's seed is 1";
      return *this->Core.step(batches) + static_cast<double>(wrong);
    }
    StagedBatches batches(this->Buffers[this->Begun.buffer]);
    return *this->Core.step(batches) + static_cast<double>(wrong);
  }

private:
  struct Buffer
  {
    std::vector<glm::vec3> positions;
    std::vector<float> targets;
  };

  class StagedBatches : public inr::BatchSource
  {
  public:
    explicit StagedBatches(const Buffer& buffer) : Staged(buffer) {}
    std::int64_t count() const override
    {
      return static_cast<std::int64_t>(this->Staged.targets.size());
    }
    std::int64_t total() const override { return this->count(); }
    void draw(std::uint64_t, std::uint64_t, std::int64_t begin, std::int64_t end,
              glm::vec3* positions, float* targets) const override
    {
      std::copy(this->Staged.positions.begin() + begin, this->Staged.positions.begin() + end,
                positions);
      std::copy(this->Staged.targets.begin() + begin, this->Staged.targets.begin() + end, targets);
    }

  private:
    const Buffer& Staged;
  };

  static void copy(const inr::StateArrays& from, const inr::StateArrays& to)
  {
    for (std::size_t k = 0; k < from.size(); ++k) {
      ASSERT_EQ(from[k].bytes, to[k].bytes);
      std::memcpy(to[k].data, from[k].data, static_cast<std::size_t>(from[k].bytes));
    }
  }

  FakeTrainingDevice& Device;
  inr::AlignedVector<float> Begin; ///< what was put
  inr::TrainingTask Task;
  inr::Arena Threads;
  inr::GradientDescent Core;
  Buffer Buffers[2];
  Step Begun{};
};

class FakeTrainer : public inr::TrainingAccelerator
{
public:
  explicit FakeTrainer(FakeTrainingDevice& device) : Device(device) {}

  std::string name() const override { return "Fake device"; }
  std::string kernel() const override { return this->Device.kernel; }
  std::unique_ptr<inr::AcceleratedTraining> start(const inr::TrainingTask& task) const override
  {
    this->Device.call();
    return std::make_unique<FakeTraining>(this->Device, task);
  }

private:
  FakeTrainingDevice& Device;
};
