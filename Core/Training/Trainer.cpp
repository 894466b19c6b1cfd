// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Trainer.h"

#include "Core/Error.h"
#include "Core/Training/Quality/Quality.h"
#include "Core/Training/TrainingLoop.h"
#include "Core/Training/TrainingRun.h"

namespace inr {

namespace {

void Measure(Model& trained, const Evaluator& evaluator, const VolumeData& volume,
             int macroCellSize, const Arena& arena, const TrainingObserver& observer)
{
  const auto keepGoing = [&](double fraction) {
    const double done = TrainingShare + (1.0 - TrainingShare) * fraction;
    return !observer || observer({TrainingPhase::Measuring, done, trained.training->steps, 0});
  };
  const DecodedReport report = MeasureQuality(evaluator, volume, trained.volume, macroCellSize,
                                              arena, keepGoing, BandSize(trained.description));
  trained.quality = report.quality;
  trained.macroCells = report.macroCells;
}

} // namespace

ModelPointer TrainModel(const VolumeData& volume, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingObserver& observer)
{
  CheckArguments(volume.values == nullptr ? glm::i64vec3(0) : volume.dims, options);
  const Arena arena(options.threads);
  VolumeInfo whole = info;
  whole.dims = volume.dims;
  whole.type = volume.type;
  TrainingRun run(whole, MeasureVolume(volume, arena), options, observer);
  if (run.isConstant()) {
    return run.constantModel();
  }
  const InMemorySource source(volume, run.volume().low, run.volume().high);
  StratifiedBatches batches(source);
  run.train(batches, PsnrEstimate(source, options.seed, arena), arena);
  std::shared_ptr<Model> trained;
  run.keepSteps([&] {
    trained = run.store(PsnrEstimate(source, options.seed, arena, PsnrEstimate::StoringVoxels));
    Measure(*trained, *MakeEvaluator(trained, options.kernel), volume, run.macroCellSize(), arena,
            observer);
  });
  return trained;
}

} // namespace inr
