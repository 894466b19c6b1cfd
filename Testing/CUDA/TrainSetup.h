// SPDX-License-Identifier: BSD-3-Clause
//
// Trainings by the GPU's kernels, on the host and on a GPU, beside Core's.
#pragma once

#include "CUDA/CudaTrainer.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Testing/CUDA/EmulatedTrainer.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

/// Any samples as mini-batches, all alike.
class GivenBatches : public inr::BatchSource
{
public:
  explicit GivenBatches(std::int64_t count, std::uint64_t seed = 3)
      : Positions(RandomPositions(count, seed))
  {
    for (std::size_t k = 0; k < this->Positions.size(); ++k) {
      this->Targets.push_back(inr::RandomUnit(seed + 1, k));
    }
  }

  std::int64_t count() const override { return static_cast<std::int64_t>(this->Targets.size()); }
  std::int64_t total() const override { return this->count(); }
  void draw(std::uint64_t, std::uint64_t, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override
  {
    std::copy(this->Positions.begin() + begin, this->Positions.begin() + end, positions);
    std::copy(this->Targets.begin() + begin, this->Targets.begin() + end, targets);
  }

  std::vector<glm::vec3> Positions;
  std::vector<float> Targets;
};

/// What a training has in memory.
struct TrainState
{
  explicit TrainState(inr::GradientDescent& descent)
  {
    const inr::StateArrays arrays = descent.state();
    const auto copyTo = [](const inr::StateArray& array, auto& values) {
      using Value = typename std::decay_t<decltype(values)>::value_type;
      const auto* from = static_cast<const Value*>(array.data);
      values.assign(from, from + array.bytes / static_cast<std::int64_t>(sizeof(Value)));
    };
    copyTo(arrays[0], this->values);
    copyTo(arrays[1], this->first);
    copyTo(arrays[2], this->second);
    copyTo(arrays[3], this->updates);
  }

  inr::StateArrays arrays()
  {
    const auto array = [](const char* name, auto& values) {
      return inr::StateArray{name, values.data(),
                             static_cast<std::int64_t>(values.size() * sizeof(values[0]))};
    };
    return {array("values", this->values), array("moment1", this->first),
            array("moment2", this->second), array("updates", this->updates)};
  }

  bool operator==(const TrainState& other) const
  {
    return this->values == other.values && this->first == other.first &&
           this->second == other.second && this->updates == other.updates;
  }

  std::vector<float> values, first, second;
  std::vector<std::uint16_t> updates;
};

/// Core's training and the kernels', from the same parameters.
struct TrainPair
{
  TrainPair(const inr::Description& description, const inr::TrainingAccelerator& accelerator,
            const inr::BatchSource& batches, float size = 0.4f)
      : Threads(2), Core(description, 1, inr::ChooseInstructionSet(""), Threads),
        Device(accelerator.start(
            {description, batches.count(), this->Core.stream(), batches.inMemory()}))
  {
    for (std::size_t k = 0; k < this->Core.parameters().size(); ++k) {
      this->Core.parameters()[k] = size * (2.0f * inr::RandomUnit(5, k) - 1.0f);
    }
    this->Core.plan(Planned);
    this->Device->put(this->Core.state());
  }

  /// A step by both: their losses.
  std::pair<double, double> step(inr::BatchSource& batches)
  {
    return {*this->Core.step(batches), this->stepOnDevice(batches)};
  }

  double stepOnDevice(const inr::BatchSource& batches)
  {
    const auto buffer = static_cast<int>(this->Steps % 2);
    if (!this->Device->drawsSamples()) {
      const inr::AcceleratedTraining::Samples samples = this->Device->samples(buffer);
      batches.draw(this->Core.stream(), this->Steps, 0, batches.count(), samples.positions,
                   samples.targets);
    }
    this->Device->begin({this->Steps, inr::LearningRate().at(this->Steps, Planned), buffer});
    ++this->Steps;
    return this->Device->finish();
  }

  TrainState ofDevice()
  {
    TrainState state(this->Core);
    this->Device->get(state.arrays());
    return state;
  }
  TrainState ofCore() { return TrainState(this->Core); }

  static constexpr std::uint64_t Planned = 40;
  inr::Arena Threads;
  inr::GradientDescent Core;
  std::unique_ptr<inr::AcceleratedTraining> Device;
  std::uint64_t Steps = 0;
};
