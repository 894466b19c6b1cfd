// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Training/Parallel/ParallelTraining.h"
#include "Core/Training/ProgressRelay.h"
#include "Core/Training/Runtime/NoMemory.h"
#include "Core/Training/Streaming/KeptSurvey.h"
#include "Core/Training/Streaming/StreamBudget.h"
#include "Core/Training/Streaming/StreamedVolume.h"
#include "Core/Training/TrainingLoop.h"
#include "Core/Training/TrainingRun.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <thread>

namespace inr {

namespace {

/// Share of the progress bar that the first reading gets.
constexpr double ReadingShare = 0.1;

/// Share of the time limit that reading again may take, where no number of steps is the end.
constexpr double RereadingShare = 0.5;

/// The default model is made to fit the limit; one that was asked for is left as it is.
TrainingOptions WithModel(TrainingOptions options, const StreamBudget& budget)
{
  if (!(options.targetRatio > 0)) {
    options.description = budget.description;
  }
  return options;
}

double ShareToRead(const StreamedVolume& volume, const TrainingOptions& options)
{
  const bool byTheClock = options.timeLimit > 0 && options.maximumSteps == 0;
  const double seconds = RereadingShare * options.timeLimit;
  const double affordable = byTheClock ? seconds / std::max(volume.surveySeconds(), 1e-3) : 1.0;
  return std::min(volume.mostRereads(), affordable);
}

std::thread Begin(const std::function<void()>& work)
{
  try {
    return std::thread(work);
  } catch (const std::system_error& problem) {
    throw Error(ErrorCode::TooLarge, "no thread can be had to train on while this one reads (" +
                                         std::string(problem.what()) +
                                         "); end other programs, or raise the limit of threads");
  }
}

/// Trains on a thread of its own while this one reads: the reader belongs to the host application,
/// which expects to be called where it called.
void TrainWhileReading(TrainingRun& run, StreamedVolume& volume, BatchSource& batches,
                       const Arena& arena, ProgressRelay& relay)
{
  std::exception_ptr failure;
  std::atomic<bool> done{false};
  std::thread trainer = Begin([&] {
    try {
      run.train(batches, volume.estimate(PsnrEstimate::UsualVoxels), arena);
    } catch (...) {
      failure = std::current_exception();
    }
    done = true;
  });
  try {
    while (!done) {
      volume.readAgain();
      relay.tell();
    }
  } catch (...) {
    relay.stop();
    trainer.join();
    if (!failure) { // all steps were done by then
      run.keepSteps([] { throw; });
    }
    throw;
  }
  trainer.join();
  if (failure) {
    std::rethrow_exception(failure);
  }
}

/// The samples of a volume, and what is worth keeping of it.
class PoolBatches : public BatchSource
{
public:
  PoolBatches(StreamedVolume& volume, SamplePool& pool, bool isFromCheckpoint)
      : Volume(volume), Pool(pool), FromCheckpoint(isFromCheckpoint)
  {}

  std::string name() const override { return this->Pool.name(); }
  TrainingPipeline pipeline() const override { return this->Pool.pipeline(); }
  StateArrays survey() override { return this->Volume.state(); }
  bool isFromCheckpoint() const override { return this->FromCheckpoint; }
  void prepare(const TrainingStep& step, const StopCheck& check) override
  {
    this->Pool.prepare(step, check);
  }
  double surveySeconds() const override { return this->Volume.surveySeconds(); }
  std::int64_t count() const override { return this->Pool.count(); }
  std::int64_t total() const override { return this->Pool.total(); }
  void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override
  {
    this->Pool.draw(stream, step, begin, end, positions, targets);
  }

protected:
  StreamedVolume& Volume;
  SamplePool& Pool;

private:
  bool FromCheckpoint;
};

/// A pool that is read on the thread that trains: the one from which a process may call the others,
/// and the host application be called. Nothing of it is in the checkpoint, which rank 0 writes: see
/// KeptSurvey.
class PoolReadBetweenSteps : public PoolBatches
{
public:
  PoolReadBetweenSteps(StreamedVolume& volume, SamplePool& pool) : PoolBatches(volume, pool, false)
  {}

  StateArrays survey() override { return {}; }
  void prepare(const TrainingStep& step, const StopCheck& check) override
  {
    if (this->Volume.readBefore(step, check)) {
      this->PoolBatches::prepare(step, check);
    }
  }
};

/// The same in all processes, whose readers may keep different arrays beside the one.
StreamBudget CommonBudget(const VolumeInfo& whole, const TrainingOptions& options,
                          const VolumeReader& reader, const TrainingGroup& group)
{
  for (const ScalarType type : group.valuesOfAll(whole.type)) {
    if (type != whole.type) {
      throw Error(ErrorCode::InvalidArgument, "the processes have values of different types");
    }
  }
  const std::vector<std::int64_t> limits = group.valuesOfAll(options.memoryLimit);
  const std::vector<std::int64_t> bytes = group.valuesOfAll(reader.bytesPerVoxel());
  TrainingOptions smallest = options;
  smallest.memoryLimit = *std::min_element(limits.begin(), limits.end());
  return PlanStream(whole, smallest, *std::max_element(bytes.begin(), bytes.end()), group.size());
}

VolumeInfo WholeOf(const VolumeReader& reader, const VolumeInfo& info)
{
  VolumeInfo whole = info;
  whole.dims = reader.dims();
  whole.type = reader.type();
  return whole;
}

/// For a second attempt: that the checkpoint is of no use was told at the first.
CheckpointOptions WithoutIgnored(CheckpointOptions options)
{
  options.tell = [tell = options.tell](CheckpointEvent event, const std::string& text) {
    if (tell && event != CheckpointEvent::Ignored) {
      tell(event, text);
    }
  };
  return options;
}

/// From the first reading to the measured model.
class StreamedTraining
{
public:
  StreamedTraining(VolumeReader& reader, const VolumeInfo& info, const TrainingOptions& asked,
                   const TrainingGroup& group, const TrainingObserver& observer)
      : Reader(reader), Group(group), Observer(observer), Whole(WholeOf(reader, info)),
        Budget(CommonBudget(this->Whole, asked, reader, group)),
        Options(WithModel(asked, this->Budget)), Threads(this->Options.threads),
        Kept(this->Whole, this->Options, group), Volume(this->makeVolume())
  {}

  ModelPointer train()
  {
    if (this->Kept.resume(*this->Volume)) {
      try {
        return this->trainOn(true);
      } catch (const UnfitSurvey&) { // as where something else trains than what began
        this->Options.checkpoint = WithoutIgnored(this->Options.checkpoint);
      }
    }
    this->Volume.reset(); // there is memory for one
    this->Volume = this->makeVolume();
    this->Volume->survey(
        [&](double done) { this->say(TrainingPhase::Reading, ReadingShare * done, 0); });
    return this->trainOn(false);
  }

private:
  std::unique_ptr<StreamedVolume> makeVolume() const
  {
    return std::make_unique<StreamedVolume>(this->Reader, this->Budget,
                                            MacroCellSizeOf(this->Whole, this->Options),
                                            this->Options, this->Group, this->Threads);
  }

  void say(TrainingPhase phase, double fraction, std::uint64_t steps) const
  {
    if (this->Observer && !this->Observer({phase, fraction, steps, 0})) {
      throw Error(ErrorCode::Cancelled, phase == TrainingPhase::Reading
                                            ? "stopped on request while the data were read"
                                            : "stopped while measuring the quality");
    }
  }

  ModelPointer trainOn(bool isFromCheckpoint)
  {
    ProgressRelay relay(this->Observer, ReadingShare);
    const TrainingObserver relayed = [&](const TrainingProgress& now) { return relay(now); };
    TrainingRun run(this->Whole, this->Volume->statistics(), this->Options, relayed, &this->Group);
    if (run.isConstant()) {
      return run.constantModel();
    }
    this->Kept.keep(*this->Volume, run, isFromCheckpoint);
    this->takeSteps(run, relay, isFromCheckpoint);
    std::shared_ptr<Model> trained;
    run.keepSteps([&] {
      this->Group.together(
          [&] { trained = run.store(this->Volume->estimate(PsnrEstimate::StoringVoxels)); });
      this->measure(*trained, *MakeEvaluator(trained, this->Options.kernel));
    });
    return trained;
  }

  void takeSteps(TrainingRun& run, ProgressRelay& relay, bool isFromCheckpoint)
  {
    StreamedVolume& volume = *this->Volume;
    SamplePool& pool = volume.begin(ShareToRead(volume, this->Options));
    if (this->Group.size() == 1) {
      PoolBatches batches(volume, pool, isFromCheckpoint);
      TrainWhileReading(run, volume, batches, this->Threads, relay);
      return;
    }
    PoolReadBetweenSteps batches(volume, pool);
    run.train(batches, volume.estimate(PsnrEstimate::UsualVoxels), this->Threads);
  }

  void measure(Model& trained, const Evaluator& evaluator)
  {
    const double begin = ReadingShare + (1.0 - ReadingShare) * TrainingShare;
    const DecodedReport report = this->Volume->measure(evaluator, trained, [&](double done) {
      this->say(TrainingPhase::Measuring, begin + (1.0 - begin) * done, trained.training->steps);
    });
    trained.quality = report.quality;
    trained.macroCells = report.macroCells;
  }

  VolumeReader& Reader;
  const TrainingGroup& Group;
  const TrainingObserver& Observer;
  VolumeInfo Whole;
  StreamBudget Budget;
  TrainingOptions Options;
  Arena Threads;
  KeptSurvey Kept;
  std::unique_ptr<StreamedVolume> Volume; ///< of which is known what a first reading tells
};

} // namespace

ModelPointer TrainModel(VolumeReader& reader, const VolumeInfo& info, const TrainingOptions& asked,
                        const TrainingObserver& observer)
{
  return TrainModel(reader, info, asked, TrainingGroup(), observer);
}

ModelPointer TrainModel(VolumeReader& reader, const VolumeInfo& info, const TrainingOptions& asked,
                        const TrainingGroup& group, const TrainingObserver& observer)
{
  CheckArguments(reader.dims(), asked);
  try {
    return StreamedTraining(reader, info, asked, group, observer).train();
  } catch (const std::bad_alloc&) {
    throw NoMemoryBesideSteps();
  }
}

} // namespace inr
