// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/Inference/EvaluateKernel.h"
#include "Core/Training/Checkpoint/CheckpointKeeper.h"
#include "Core/Training/Descent/Descent.h"
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/Runtime/TrainingClock.h"
#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/StepPlan.h"
#include "Core/Training/Trainer.h"

#include <cstdint>
#include <functional>
#include <string>

namespace inr {

/// Share of the progress bar that training gets when quality is measured afterwards.
constexpr double TrainingShare = 0.9;

/// What batches have from a checkpoint fits nothing but the rest of its training, and that is not
/// what follows.
class UnfitSurvey : public Error
{
public:
  using Error::Error;
};

/// Throws `error` with what `keep`, which rank 0 calls, says is kept of the steps; in all processes
/// of a group, and not before that is done: whoever started them may end all when one has ended.
[[noreturn]] void StopTraining(const Error& error, const TrainingGroup& group,
                               const std::function<std::string()>& keep);

/// Steps until one of the options' limits is reached, telling the observer.
class TrainingLoop
{
public:
  /// In a group rank 0 decides when to stop and what the plan is, and has the checkpoint.
  TrainingLoop(const TrainingOptions& options, const TrainingObserver& observer,
               CheckpointKeeper& keeper, const TrainingGroup& group, TrainingPipeline pipeline)
      : Options(options), Observer(observer), Keeper(keeper), Group(group), Pipeline(pipeline)
  {}

  /// Throws what TrainModel says of training itself and, before the first step, UnfitSurvey. The
  /// checkpoint is written between steps and before an error.
  void run(Descent& descent, BatchSource& batches, const PsnrEstimate& estimate,
           const EvaluateKernel& kernel);

  /// Of the run, with what went before its checkpoint: wall time, and the steps that its learning
  /// rate was spread over.
  double seconds() const { return this->Clock.seconds(); }
  std::uint64_t plannedSteps() const { return this->PlannedSteps; }
  /// Whether it began anew from random parameters, as the network was stuck.
  bool beganAnew() const { return this->Anew > 0; }

  /// What a checkpoint says of it.
  TrainingState state(const Descent& descent, bool finished) const;

private:
  void planAhead(Descent& descent);
  void resume(Descent& descent, BatchSource& batches);
  void shareArrays(const StateArrays& arrays) const;
  bool goesOn(Descent& descent);
  void train(Descent& descent, BatchSource& batches, const PsnrEstimate& estimate,
             const EvaluateKernel& kernel);
  void finish(Descent& descent);
  [[noreturn]] void stop(Descent& descent, const Error& error);
  void write(Descent& descent);
  void plan(Descent& descent, std::uint64_t steps);
  void noteFirst(std::uint64_t steps);
  void planByTheClock(Descent& descent);
  double storingLoss() const;
  bool reachedTarget(Descent& descent, const PsnrEstimate& estimate, const EvaluateKernel& kernel,
                     const StopCheck& check);
  void helpIfStuck(Descent& descent, const PsnrEstimate& estimate, const EvaluateKernel& kernel,
                   const StopCheck& check);
  bool timeIsUp() const;
  bool reachedLimit(std::uint64_t steps) const;
  bool keepGoing(std::uint64_t steps);
  double fraction(std::uint64_t steps) const;
  void report(std::uint64_t steps);

  const TrainingOptions& Options;
  const TrainingObserver& Observer;
  CheckpointKeeper& Keeper;
  const TrainingGroup& Group;
  TrainingPipeline Pipeline;
  bool IsAccelerated = false;
  TimedSteps Timed; ///< from where it is seen how many steps a time allows
  TrainingClock Clock;
  bool Finished = false;          ///< before it was stopped
  std::uint64_t PlannedSteps = 0; ///< 0 until there is a plan
  bool IsPlanFinal = false;       ///< the clock has no say in it, or has had it
  std::uint64_t Anew = 0;         ///< times that it began so
  double Psnr = 0;
  double Fraction = 0;
  double LastReport = 0;
};

} // namespace inr
