// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/Checkpoint/CheckpointKeeper.h"
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Samples/BatchSource.h"
#include "Core/Training/Trainer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace inr {

class AcceleratedDescent;
class GradientDescent;

/// A model from the choice of its size to its parameters as they are stored: what training is
/// wherever the samples come from.
class TrainingRun
{
public:
  /// Throws what TrainModel says of its arguments. All of them must outlive this. In a group all
  /// have the same arguments; rank 0 has the checkpoint.
  TrainingRun(const VolumeInfo& info, const VolumeStatistics& statistics,
              const TrainingOptions& options, const TrainingObserver& observer,
              const TrainingGroup* group = nullptr);
  ~TrainingRun();

  int macroCellSize() const { return this->MacroCellSize; }
  const VolumeInfo& volume() const { return this->Result.volume; }

  /// Whether all finite voxels are equal, for all that doubles tell: no step is needed to be as
  /// exact as can be.
  bool isConstant() const;
  ModelPointer constantModel();

  /// What tells its checkpoint from those of other trainings.
  TrainingIdentity identity(const PsnrEstimate& estimate, const BatchSource& batches) const;

  /// Takes steps until a limit is reached.
  void train(BatchSource& batches, const PsnrEstimate& estimate, const Arena& arena);

  /// Makes the parameters what the file will hold; quality and macro-cells are still to be
  /// measured. `estimate` has more voxels than that of train: a tenth of a dB is to be told.
  std::shared_ptr<Model> store(const PsnrEstimate& estimate);

  /// Does `work`, all that comes after the steps. Where it throws, the steps are kept first, as
  /// they are when training itself is stopped. In a group what is an Error in one is so in all.
  void keepSteps(const std::function<void()>& work);

private:
  std::unique_ptr<AcceleratedDescent> accelerate(GradientDescent& host, const BatchSource& batches,
                                                 const Arena& arena) const;
  void takeSteps(BatchSource& batches, const PsnrEstimate& estimate, const Arena& arena);
  void startFromOther(GradientDescent& descent, const PsnrEstimate& estimate);
  std::string writeSteps();
  void record(const AcceleratedDescent* accelerated);
  StopCheck storingCheck() const;
  const TrainingGroup& group() const { return this->Together ? *this->Together : this->Alone; }

  const TrainingOptions& Options;
  const TrainingObserver& Observer;
  TrainingGroup Alone;
  const TrainingGroup* Together; ///< null = alone
  InstructionSet Set;
  int MacroCellSize;
  double ConstantError; ///< of a constant volume that no double is
  Model Result;
  std::optional<CheckpointKeeper> Keeper; ///< since there are steps to keep
  std::unique_ptr<GradientDescent> Steps; ///< null where they are on disk, or not to be kept
  TrainingState End;                      ///< of them
};

/// Throws for options that no training can have, and where there is nothing to train on.
void CheckArguments(const glm::i64vec3& dims, const TrainingOptions& options);

/// As the options say, or the default.
int MacroCellSizeOf(const VolumeInfo& volume, const TrainingOptions& options);

/// Voxels that are decoded in about a second: the larger the network, the fewer.
std::int64_t BandSize(const Description& description);

} // namespace inr
