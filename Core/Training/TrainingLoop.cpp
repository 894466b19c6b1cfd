// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/TrainingLoop.h"

#include "Core/Error.h"
#include "Core/NumberText.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Quantise.h"
#include "Core/Training/Runtime/LearningRate.h"
#include "Core/Training/Runtime/NoMemory.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace inr {

namespace {

constexpr std::uint64_t PsnrInterval = 200;
constexpr double ReportInterval = 0.2; // seconds, within a step

void RequireFinite(bool finite, std::uint64_t steps)
{
  if (!finite) {
    throw Error(ErrorCode::InvalidModel,
                "the training diverged in step " + std::to_string(steps) +
                    ": the network's output is not finite; choose another activation or fewer "
                    "layers in ModelConfig");
  }
}

} // namespace

void StopTraining(const Error& error, const TrainingGroup& group,
                  const std::function<std::string()>& keep)
{
  const std::string kept = group.rank() == 0 ? "; " + keep() : "";
  try {
    group.gather("");
  } catch (const Error&) { // nobody can be reached any more
  }
  throw Error(error.code(), error.what() + kept);
}

void TrainingLoop::run(Descent& descent, BatchSource& batches, const PsnrEstimate& estimate,
                       const EvaluateKernel& kernel)
{
  this->planAhead(descent);
  this->resume(descent, batches);
  if (this->Finished) {
    return;
  }
  try {
    this->train(descent, batches, estimate, kernel);
  } catch (const Error& error) {
    this->stop(descent, error);
  } catch (const std::bad_alloc&) {
    if (this->Group.size() > 1) { // outside of what all do together: nobody would answer
      throw NoMemoryToTrain();
    }
    this->stop(descent, NoMemoryToTrain());
  }
  this->finish(descent);
  const StateArrays arrays = descent.state();
  this->Keeper.writeAtEnd(this->state(descent, true), arrays);
}

/// Throws it, with what is kept of the steps before.
void TrainingLoop::stop(Descent& descent, const Error& error)
{
  if (error.code() == ErrorCode::InvalidModel) {
    throw error; // there is nothing to go on from
  }
  StopTraining(error, this->Group, [&] {
    const StateArrays arrays = descent.state(); // which may change the number of steps
    return this->Keeper.writeAtStop(this->state(descent, false), arrays);
  });
}

void TrainingLoop::planAhead(Descent& descent)
{
  const std::uint64_t steps = StepsAhead(this->Options);
  if (steps > 0) {
    this->plan(descent, steps);
  }
  this->IsPlanFinal = !ClockPlans(this->Options);
}

/// An error in the middle of a step leaves the parameters of the steps before it.
void TrainingLoop::train(Descent& descent, BatchSource& batches, const PsnrEstimate& estimate,
                         const EvaluateKernel& kernel)
{
  const StopCheck check([&] { return this->keepGoing(descent.steps()); });
  while (this->goesOn(descent)) {
    const std::optional<double> loss = descent.step(batches, check);
    if (!loss) { // the time is up, and the step was dropped
      break;
    }
    RequireFinite(std::isfinite(*loss), descent.steps());
    this->IsAccelerated = descent.isAccelerated();
    this->noteFirst(descent.steps());
    if (this->reachedTarget(descent, estimate, kernel, check)) {
      break;
    }
    this->helpIfStuck(descent, estimate, kernel, check);
    this->planByTheClock(descent);
    this->Group.together([&] { this->report(descent.steps()); });
    if (this->Keeper.isDue()) {
      this->write(descent);
    }
  }
}

void TrainingLoop::write(Descent& descent)
{
  const StateArrays arrays = descent.state(); // which may change the number of steps
  this->Keeper.write(this->state(descent, false), arrays);
}

void TrainingLoop::finish(Descent& descent)
{
  // The last update is not seen in any loss.
  const AlignedVector<float>& parameters = descent.parameters();
  if (descent.steps() == 0) {
    throw Error(ErrorCode::InvalidArgument,
                "not one step of the training was finished within the TimeLimit of " +
                    NumberText(this->Options.timeLimit) + " s; raise it or choose a smaller model");
  }
  RequireFinite(std::all_of(parameters.begin(), parameters.end(),
                            [](float parameter) { return std::isfinite(parameter); }),
                descent.steps());
  if (this->PlannedSteps == 0) { // the rate was constant to the end
    this->plan(descent, LearningRate::ConstantShare * descent.steps());
  }
}

/// As rank 0 says.
bool TrainingLoop::goesOn(Descent& descent)
{
  struct Decision
  {
    bool goesOn;
    std::uint64_t plannedSteps;
  };
  if (this->reachedLimit(descent.steps())) {
    descent.parameters(); // the last steps count when they are here
  }
  const Decision decision =
      this->Group.valueOfFirst(Decision{!this->reachedLimit(descent.steps()), this->PlannedSteps});
  if (decision.plannedSteps != this->PlannedSteps) {
    this->plan(descent, decision.plannedSteps);
  }
  return decision.goesOn;
}

void TrainingLoop::resume(Descent& descent, BatchSource& batches)
{
  struct Before
  {
    bool known;
    TrainingState state;
  };
  this->Keeper.keep(batches.survey());
  const std::optional<TrainingState> mine = this->Keeper.resume(descent.state());
  if (batches.isFromCheckpoint() && !mine) {
    throw UnfitSurvey(ErrorCode::CannotRead,
                      "'" + this->Options.checkpoint.path + "' is of another training");
  }
  const Before before =
      this->Group.valueOfFirst(Before{mine.has_value(), mine.value_or(TrainingState())});
  if (!before.known) {
    this->Keeper.count(batches.surveySeconds());
    return;
  }
  this->shareArrays(descent.state());
  descent.goOnAfter(before.state.steps);
  if (before.state.plannedSteps > 0) {
    this->plan(descent, before.state.plannedSteps);
    // It had been looked at by then.
    this->IsPlanFinal =
        this->IsPlanFinal || before.state.seconds >= TimingShare * this->Options.timeLimit;
  }
  this->Clock = TrainingClock(before.state.seconds);
  this->LastReport = before.state.seconds;
  this->Psnr = before.state.psnr;
  this->Finished = before.state.finished;
  this->Anew = before.state.anew;
}

/// Gives all what rank 0 has read.
void TrainingLoop::shareArrays(const StateArrays& arrays) const
{
  constexpr std::int64_t pieceSize = 1 << 24;
  for (const StateArray& array : arrays) {
    for (std::int64_t done = 0; done<array.bytes&& this->Group.size()> 1; done += pieceSize) {
      char* const piece = static_cast<char*>(array.data) + done;
      const auto bytes = static_cast<std::size_t>(std::min(pieceSize, array.bytes - done));
      const std::string first = this->Group.fromFirst(std::string(piece, bytes));
      std::copy(first.begin(), first.end(), piece);
    }
  }
}

TrainingState TrainingLoop::state(const Descent& descent, bool finished) const
{
  return {descent.steps(), this->PlannedSteps, this->Clock.seconds(),
          this->Psnr,      finished,           this->Anew};
}

void TrainingLoop::plan(Descent& descent, std::uint64_t steps)
{
  this->PlannedSteps = steps;
  descent.plan(steps);
}

/// An accelerator takes its first step together with the CPU: that says nothing of the others.
void TrainingLoop::noteFirst(std::uint64_t steps)
{
  if (this->IsAccelerated && this->Timed.steps == 0) {
    this->Timed = {steps, this->Clock.seconds()};
  } else if (!this->IsAccelerated) {
    this->Timed = {};
  }
}

/// Plans as many steps as the time limit allows, once that is known.
void TrainingLoop::planByTheClock(Descent& descent)
{
  const TimedSteps now{descent.steps(), this->Clock.seconds()};
  const double seconds = now.seconds - this->Timed.seconds;
  if (this->IsPlanFinal || seconds < TimingShare * this->Options.timeLimit ||
      this->Group.rank() > 0) {
    return;
  }
  this->IsPlanFinal = true;
  this->plan(descent, StepsByTheClock(this->Options, this->Timed, now));
}

/// In dB, that storing the parameters may cost afterwards.
double TrainingLoop::storingLoss() const
{
  constexpr double lossForRatio = 1.0; // mostly
  if (this->Options.storedAs != ParameterType::Quantised) {
    return 0.0;
  }
  const bool fitsRatio = this->Options.targetRatio > 0 && !this->Options.description;
  return fitsRatio ? lossForRatio : QuantiseLimits().loss;
}

bool TrainingLoop::reachedTarget(Descent& descent, const PsnrEstimate& estimate,
                                 const EvaluateKernel& kernel, const StopCheck& check)
{
  // At fixed steps, so that a run which ends by quality ends at the same step every time.
  if (this->Options.targetPsnr <= 0 || descent.steps() % PsnrInterval != 0) {
    return false;
  }
  this->Group.together([&] { this->Psnr = estimate.measure(descent.view(), kernel, check); });
  return this->Group.valueOfFirst(this->Psnr >= this->Options.targetPsnr + this->storingLoss());
}

/// Rectified units may all be off after some steps too long: those of one of 132 trainings were, of
/// a single voxel in zeros.
void TrainingLoop::helpIfStuck(Descent& descent, const PsnrEstimate& estimate,
                               const EvaluateKernel& kernel, const StopCheck& check)
{
  constexpr std::uint64_t mostOften = 3; // then it is not chance
  constexpr double tooLate = 0.9;        // of the training, for another one
  const std::uint64_t steps = descent.steps();
  const bool isEarly = steps == 50 || steps == 100 || steps == PsnrInterval;
  // To look at what an accelerator has takes time.
  const bool isLater = steps % PsnrInterval == 0 && !descent.isAccelerated();
  if ((!isEarly && !isLater) || this->Anew == mostOften) {
    return;
  }
  bool isStuck = false;
  this->Group.together([&] { isStuck = estimate.isStuck(descent.view(), kernel, check); });
  if (this->Group.valueOfFirst(isStuck && this->fraction(steps) < tooLate)) {
    ++this->Anew;
    descent.startAnew(this->Options.seed + this->Anew);
  }
}

bool TrainingLoop::timeIsUp() const
{
  return this->Options.timeLimit > 0 && this->Clock.seconds() >= this->Options.timeLimit;
}

bool TrainingLoop::reachedLimit(std::uint64_t steps) const
{
  return (this->Options.maximumSteps > 0 && steps >= this->Options.maximumSteps) ||
         this->timeIsUp();
}

/// Within a step, which may take minutes: false when the time is up, throws when the user stops.
bool TrainingLoop::keepGoing(std::uint64_t steps)
{
  if (this->Clock.seconds() - this->LastReport >= ReportInterval) {
    this->report(steps);
  }
  return !this->timeIsUp();
}

double TrainingLoop::fraction(std::uint64_t steps) const
{
  double done = 0;
  if (this->Options.maximumSteps > 0) {
    done = static_cast<double>(steps) / static_cast<double>(this->Options.maximumSteps);
  }
  if (this->Options.timeLimit > 0) {
    done = std::max(done, this->Clock.seconds() / this->Options.timeLimit);
  }
  // The dB of the target say nothing: most of them are there after the first tenth of the steps.
  if (this->Options.targetPsnr > 0 && this->PlannedSteps > 0) {
    done = std::max(done, static_cast<double>(steps) / static_cast<double>(this->PlannedSteps));
  }
  return std::clamp(done, 0.0, 1.0);
}

void TrainingLoop::report(std::uint64_t steps)
{
  this->LastReport = this->Clock.seconds();
  this->Fraction = std::max(this->Fraction, TrainingShare * this->fraction(steps));
  if (this->Observer && !this->Observer({TrainingPhase::Training, this->Fraction, steps, this->Psnr,
                                         this->IsAccelerated, this->Pipeline})) {
    throw Error(ErrorCode::Cancelled, "training stopped on request");
  }
}

} // namespace inr
