// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Parallel/ParallelTraining.h"

#include "Core/Error.h"
#include "Core/Training/Parallel/PieceBatches.h"
#include "Core/Training/Quality/Quality.h"
#include "Core/Training/TrainingLoop.h"
#include "Core/Training/TrainingRun.h"

namespace inr {

namespace {

VolumeStatistics Measure(const VolumePart& part, const TrainingGroup& group, const Arena& arena)
{
  VolumeStatistics own;
  const GridBox voxels = part.voxels();
  if (voxels.count() > 0) {
    own = MeasureBox(part.piece(), voxels, arena);
  }
  VolumeStatistics all;
  for (const VolumeStatistics& each : group.valuesOfAll(own)) {
    all.add(each);
  }
  return all;
}

DecodedReport MeasureParts(const Evaluator& evaluator, const VolumePart& part,
                           const VolumeInfo& info, int macroCellSize, const TrainingGroup& group,
                           const Arena& arena, const std::function<void(double)>& check,
                           std::int64_t bandSize)
{
  QualityMeter meter(evaluator, info, arena, bandSize);
  CellRanges cells(info.dims, macroCellSize);
  group.together([&] {
    const GridBox voxels = part.voxels();
    if (voxels.count() > 0) {
      meter.add(part.piece(), voxels, &cells, check);
    } else { // it may stop the others, too
      check(0);
    }
  });
  meter.gather(group);
  cells.gather(group);
  return {meter.quality(), cells.cells(0.0, 1.0, 0.0, MacroCellProvenance::Decoded)};
}

} // namespace

ModelPointer TrainModel(const VolumePiece& piece, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingGroup& group,
                        const TrainingObserver& observer)
{
  CheckArguments(info.dims, options);
  const Arena arena(options.threads);
  const VolumePart part(piece, info.dims, group);
  TrainingRun run(info, Measure(part, group, arena), options, observer, &group);
  if (run.isConstant()) {
    return run.constantModel();
  }
  const double low = run.volume().low;
  const double high = run.volume().high;
  const SharedSource source(part, group, low, high);
  PieceBatches batches(part, low, high, group.size());
  run.train(batches, PsnrEstimate(source, options.seed, arena), arena);
  const PsnrEstimate estimate(source, options.seed, arena, PsnrEstimate::StoringVoxels);
  std::shared_ptr<Model> trained;
  const auto check = [&](double fraction) {
    const double done = TrainingShare + (1.0 - TrainingShare) * fraction;
    if (observer && !observer({TrainingPhase::Measuring, done, trained->training->steps, 0})) {
      throw Error(ErrorCode::Cancelled, "stopped while measuring the quality");
    }
  };
  run.keepSteps([&] {
    group.together([&] { trained = run.store(estimate); });
    const DecodedReport report =
        MeasureParts(*MakeEvaluator(trained, options.kernel), part, trained->volume,
                     run.macroCellSize(), group, arena, check, BandSize(trained->description));
    trained->quality = report.quality;
    trained->macroCells = report.macroCells;
  });
  return trained;
}

} // namespace inr
