// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Training/ProgressRelay.h"
#include "Core/Training/StreamBudget.h"
#include "Core/Training/StreamedVolume.h"
#include "Core/Training/TrainingLoop.h"
#include "Core/Training/TrainingRun.h"

#include <algorithm>
#include <atomic>
#include <exception>
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

double ShareToRead(const StreamedVolume& volume, const TrainingOptions& options)
{
  const bool byTheClock = options.timeLimit > 0 && options.maximumSteps == 0;
  const double seconds = RereadingShare * options.timeLimit;
  const double affordable = byTheClock ? seconds / std::max(volume.surveySeconds(), 1e-3) : 1.0;
  return std::min(volume.mostRereads(), affordable);
}

/// Trains on a thread of its own while this one reads: the reader belongs to the host application,
/// which expects to be called where it called.
void TrainWhileReading(TrainingRun& run, StreamedVolume& volume, SamplePool& pool,
                       const Arena& arena, ProgressRelay& relay)
{
  std::exception_ptr failure;
  std::atomic<bool> done{false};
  std::thread trainer([&] {
    try {
      run.train(pool, volume.estimate(PsnrEstimate::UsualVoxels), arena);
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

} // namespace

ModelPointer TrainModel(VolumeReader& reader, const VolumeInfo& info, const TrainingOptions& asked,
                        const TrainingObserver& observer)
{
  CheckArguments(reader.dims(), asked);
  VolumeInfo whole = info;
  whole.dims = reader.dims();
  whole.type = reader.type();
  const StreamBudget budget = PlanStream(whole, asked, reader.bytesPerVoxel());
  const TrainingOptions options = WithModel(asked, budget);
  const Arena arena(options.threads);
  const auto say = [&](TrainingPhase phase, double fraction, std::uint64_t steps) {
    if (observer && !observer({phase, fraction, steps, 0})) {
      throw Error(ErrorCode::Cancelled, phase == TrainingPhase::Reading
                                            ? "stopped on request while the data were read"
                                            : "stopped while measuring the quality");
    }
  };

  StreamedVolume volume(reader, budget, MacroCellSizeOf(whole, options), options, arena);
  volume.survey([&](double done) { say(TrainingPhase::Reading, ReadingShare * done, 0); });
  ProgressRelay relay(observer, ReadingShare);
  const TrainingObserver relayed = [&](const TrainingProgress& now) { return relay(now); };
  TrainingRun run(whole, volume.statistics(), options, relayed);
  if (run.isConstant()) {
    return run.constantModel();
  }
  TrainWhileReading(run, volume, volume.begin(ShareToRead(volume, options)), arena, relay);
  const std::shared_ptr<Model> trained = run.store(volume.estimate(PsnrEstimate::StoringVoxels));

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
