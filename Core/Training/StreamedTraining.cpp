// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Training/KeptSurvey.h"
#include "Core/Training/ParallelTraining.h"
#include "Core/Training/ProgressRelay.h"
#include "Core/Training/StreamBudget.h"
#include "Core/Training/StreamedVolume.h"
#include "Core/Training/TrainingLoop.h"
#include "Core/Training/TrainingRun.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <thread>

namespace inr {

namespace {

/// Share of the progress bar that the first reading gets.
constexpr double ReadingShare = 0.1;

/// Share of the time limit that reading again may take, where nothing but the clock is the end.
constexpr double RereadingShare = 0.5;

/// The default model is made to fit the limit; one that was asked for is left as it is.
TrainingOptions WithModel(TrainingOptions options, const StreamBudget& budget)
{
  if (!(options.targetRatio > 0)) {
    options.description = budget.description;
  }
  return options;
}

/// A volume of which is known what a first reading tells.
struct Surveyed
{
  std::unique_ptr<StreamedVolume> volume;
  bool isFromCheckpoint = false;
};

double ShareToRead(const StreamedVolume& volume, const TrainingOptions& options)
{
  const bool byTheClock = options.timeLimit > 0 && options.maximumSteps == 0;
  const double seconds = RereadingShare * options.timeLimit;
  const double affordable = byTheClock ? seconds / std::max(volume.surveySeconds(), 1e-3) : 1.0;
  return std::min(volume.mostRereads(), affordable);
}

/// Trains on a thread of its own while this one reads: the reader belongs to the host application,
/// which expects to be called where it called.
void TrainWhileReading(TrainingRun& run, StreamedVolume& volume, BatchSource& batches,
                       const Arena& arena, ProgressRelay& relay)
{
  std::exception_ptr failure;
  std::atomic<bool> done{false};
  std::thread trainer([&] {
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

void Train(TrainingRun& run, Surveyed& surveyed, const TrainingGroup& group, const Arena& arena,
           ProgressRelay& relay, double rereads)
{
  StreamedVolume& volume = *surveyed.volume;
  SamplePool& pool = volume.begin(rereads);
  if (group.size() == 1) {
    PoolBatches batches(volume, pool, surveyed.isFromCheckpoint);
    TrainWhileReading(run, volume, batches, arena, relay);
    return;
  }
  PoolReadBetweenSteps batches(volume, pool);
  run.train(batches, volume.estimate(PsnrEstimate::UsualVoxels), arena);
}

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
  VolumeInfo whole = info;
  whole.dims = reader.dims();
  whole.type = reader.type();
  const StreamBudget budget = CommonBudget(whole, asked, reader, group);
  const TrainingOptions options = WithModel(asked, budget);
  const Arena arena(options.threads);
  const auto say = [&](TrainingPhase phase, double fraction, std::uint64_t steps) {
    if (observer && !observer({phase, fraction, steps, 0})) {
      throw Error(ErrorCode::Cancelled, phase == TrainingPhase::Reading
                                            ? "stopped on request while the data were read"
                                            : "stopped while measuring the quality");
    }
  };

  const auto makeVolume = [&] {
    return std::make_unique<StreamedVolume>(reader, budget, MacroCellSizeOf(whole, options),
                                            options, group, arena);
  };
  Surveyed surveyed{makeVolume()};
  const KeptSurvey kept(whole, options, group);
  surveyed.isFromCheckpoint = kept.resume(*surveyed.volume);
  if (!surveyed.isFromCheckpoint) {
    surveyed.volume.reset(); // there is memory for one
    surveyed.volume = makeVolume();
    surveyed.volume->survey(
        [&](double done) { say(TrainingPhase::Reading, ReadingShare * done, 0); });
  }
  StreamedVolume& volume = *surveyed.volume;
  ProgressRelay relay(observer, ReadingShare);
  const TrainingObserver relayed = [&](const TrainingProgress& now) { return relay(now); };
  TrainingRun run(whole, volume.statistics(), options, relayed, &group);
  if (run.isConstant()) {
    return run.constantModel();
  }
  kept.keep(volume, run, surveyed.isFromCheckpoint);
  Train(run, surveyed, group, arena, relay, ShareToRead(volume, options));
  std::shared_ptr<Model> trained;
  group.together([&] { trained = run.store(volume.estimate(PsnrEstimate::StoringVoxels)); });

  const double begin = ReadingShare + (1.0 - ReadingShare) * TrainingShare;
  const DecodedReport report =
      volume.measure(*MakeEvaluator(trained, options.kernel), *trained, [&](double done) {
        say(TrainingPhase::Measuring, begin + (1.0 - begin) * done, trained->training->steps);
      });
  trained->quality = report.quality;
  trained->macroCells = report.macroCells;
  return trained;
}

} // namespace inr
