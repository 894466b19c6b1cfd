// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Training/Runtime/StateArray.h"
#include "Core/Training/Runtime/StopCheck.h"
#include "Core/Training/Samples/SampleSource.h"
#include "Core/Training/Samples/StratifiedPositions.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace inr {

/// Positions per mini-batch.
constexpr std::int64_t BatchSize = 1 << 14;

/// "device memory", "host memory", "storage".
const char* TrainingPipelineName(TrainingPipeline pipeline);

/// Where a training is: steps done, and how many are planned (the largest number = no end in
/// sight).
struct TrainingStep
{
  std::uint64_t number = 0;
  std::uint64_t planned = 0;
  std::uint64_t stream = 0; ///< of random numbers
};

/// The mini-batches of a training, in an order that keeps neighbours together.
class BatchSource
{
public:
  virtual ~BatchSource() = default;

  /// What distinguishes its samples from those of another source of the same volume, for the user.
  virtual std::string name() const { return "of the volume in memory"; }

  /// Where its samples come from.
  virtual TrainingPipeline pipeline() const { return TrainingPipeline::HostMemory; }

  /// The volume whose StratifiedBatches these are, where it is in memory: an accelerator may draw
  /// them from a copy.
  virtual std::optional<NormalisedVolume> inMemory() const { return std::nullopt; }

  /// Called before the items of a step are drawn, by the thread that trains. May wait for data as
  /// long as `check` lets it. In a group all processes call it together: it may call the group, and
  /// what it throws in one, it has to throw in all.
  virtual void prepare(const TrainingStep&, const StopCheck&) {}

  /// What it has learnt of the data and would have to read again; for checkpoints. Between
  /// prepare() of one step and of the next it stays as it is. Empty = nothing worth keeping.
  virtual StateArrays survey() { return {}; }

  /// Seconds that it took to learn that.
  virtual double surveySeconds() const { return 0; }

  /// Whether that came out of a checkpoint: then it fits nothing but the rest of that training;
  /// see UnfitSurvey.
  virtual bool isFromCheckpoint() const { return false; }

  /// Samples of the prepared mini-batch: that are drawn here, and with those of other processes.
  virtual std::int64_t count() const { return BatchSize; }
  virtual std::int64_t total() const { return BatchSize; }

  /// Items [begin, end) of the mini-batch of step number `step`: positions in the unit cube and
  /// their targets (see SampleSource). Depends on the arguments and on what was prepared alone;
  /// safe to call from several threads at once.
  virtual void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
                    glm::vec3* positions, float* targets) const = 0;
};

/// A sample in each of BatchSize StratifiedPositions.
class StratifiedBatches : public BatchSource
{
public:
  /// `source` must outlive this.
  explicit StratifiedBatches(const SampleSource& source)
      : Source(source), Boxes(source.dims(), BatchSize)
  {}

  std::optional<NormalisedVolume> inMemory() const override { return this->Source.inMemory(); }
  void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override;

private:
  const SampleSource& Source;
  StratifiedPositions Boxes;
};

} // namespace inr
