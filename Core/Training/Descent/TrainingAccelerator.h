// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Description.h"
#include "Core/Training/Runtime/StateArray.h"
#include "Core/Training/Samples/SampleSource.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace inr {

/// What an accelerator is to train.
struct TrainingTask
{
  Description description;
  std::int64_t samples = 0;               ///< of a mini-batch
  std::uint64_t stream = 0;               ///< of random numbers, where it draws them
  std::optional<NormalisedVolume> volume; ///< whose StratifiedBatches they are, if it is in memory
};

/// A training in the memory of an accelerator. All throw Error(Device) where that fails; it is of
/// no use any more then. One thread at a time.
class AcceleratedTraining
{
public:
  AcceleratedTraining() = default;
  virtual ~AcceleratedTraining() = default;
  AcceleratedTraining(const AcceleratedTraining&) = delete;
  AcceleratedTraining& operator=(const AcceleratedTraining&) = delete;

  /// Whether it has a copy of the volume and draws mini-batches from it: those that
  /// StratifiedBatches would draw, to the last bit.
  virtual bool drawsSamples() const = 0;

  /// Copies GradientDescent::state() there and back, in its order; get() waits for it.
  virtual void put(const StateArrays& state) = 0;
  virtual void get(const StateArrays& state) = 0;

  /// Room for a mini-batch in the host's memory, where it draws none: one of two, 0 and 1, from
  /// which a step takes it. The other one may be filled meanwhile.
  struct Samples
  {
    glm::vec3* positions;
    float* targets;
  };
  virtual Samples samples(int buffer) = 0;

  struct Step
  {
    std::uint64_t number; ///< from 0
    float learningRate;
    int buffer; ///< of its samples
  };
  /// Begins GradientDescent's step, to within float32's rounding, but for how gradients are added
  /// up. The samples stay as they are until finish(), which returns the mean squared error.
  virtual void begin(const Step& step) = 0;
  virtual double finish() = 0;
};

/// A processor beside the CPU that trains, such as a GPU.
class TrainingAccelerator
{
public:
  TrainingAccelerator() = default;
  virtual ~TrainingAccelerator() = default;
  TrainingAccelerator(const TrainingAccelerator&) = delete;
  TrainingAccelerator& operator=(const TrainingAccelerator&) = delete;

  virtual std::string name() const = 0;   ///< "CUDA float32, NVIDIA H200"
  virtual std::string kernel() const = 0; ///< of the training record: "cuda float32"

  /// Takes the volume into its memory where there is room for it. Throws Error(Device) where there
  /// is none for the training.
  virtual std::unique_ptr<AcceleratedTraining> start(const TrainingTask& task) const = 0;
};

enum class AccelerationEvent {
  NotUsed, ///< there is an accelerator, but not for this training
  Failed   ///< in the middle; the CPU goes on
};

/// With what to train, beside the CPU.
struct AccelerationOptions
{
  std::shared_ptr<const TrainingAccelerator> accelerator; ///< null = the CPU trains
  /// Called on the thread that trains, with a sentence for the user.
  std::function<void(AccelerationEvent, const std::string&)> tell;
};

} // namespace inr
