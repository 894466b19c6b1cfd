// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Trainer.h"

#include "Core/Error.h"
#include "Core/Inference/EvaluateKernel.h"
#include "Core/Model/CompactBlobs.h"
#include "Core/Model/Compression.h"
#include "Core/Model/ModelFile.h"
#include "Core/Model/Quantised.h"
#include "Core/Training/PsnrEstimate.h"
#include "Core/Training/Quality.h"
#include "Core/Training/Quantise.h"
#include "Core/Training/TrainingLoop.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace inr {

namespace {

void CheckArguments(const VolumeData& volume, const TrainingOptions& options)
{
  if (volume.values == nullptr || volume.dims.x < 1 || volume.dims.y < 1 || volume.dims.z < 1) {
    throw Error(ErrorCode::InvalidArgument, "there are no voxels to train on");
  }
  const int edge = options.macroCellSize;
  if (edge < 0 || (edge & (edge - 1)) != 0) {
    throw Error(ErrorCode::InvalidArgument, "MacroCellSize is " + std::to_string(edge) +
                                                "; set a power of two, or 0 for the default");
  }
  const bool limited = options.targetPsnr > 0 || options.maximumSteps > 0 || options.timeLimit > 0;
  if (!limited) {
    throw Error(ErrorCode::InvalidArgument,
                "training would never end: set TargetPSNR, MaximumSteps or TimeLimit");
  }
}

/// Goes on from the start's parameters where these fit, which is then on record.
void StartFrom(const ModelPointer& start, Model& model, GradientDescent& descent)
{
  if (start && start->description == model.description) {
    descent.startFrom(start->parameters);
    const TrainingRecord before = start->training.value_or(TrainingRecord());
    model.training->earlierSteps = before.steps + before.earlierSteps.value_or(0);
  }
}

/// Makes the parameters what the file gives back; keeps them as floats where a half cannot hold
/// one.
void RoundAsStored(Model& model)
{
  if (model.storedAs == ParameterType::Quantised) {
    return;
  }
  const auto fits = [](float parameter) { return std::abs(parameter) <= HALF_MAX; };
  if (!std::all_of(model.parameters.begin(), model.parameters.end(), fits)) {
    model.storedAs = ParameterType::Float;
  }
  if (model.storedAs == ParameterType::Half) {
    for (float& parameter : model.parameters) {
      parameter = static_cast<float>(Imath::half(parameter));
    }
  }
}

/// Lets the observer stop what comes between training and measuring.
StopCheck CheckOf(const TrainingObserver& observer, std::uint64_t steps)
{
  return StopCheck([&observer, steps, clock = TrainingClock(), last = 0.0]() mutable {
    constexpr double interval = 0.2; // seconds
    if (observer && clock.seconds() - last >= interval) {
      last = clock.seconds();
      if (!observer({TrainingPhase::Measuring, TrainingShare, steps, 0})) {
        throw Error(ErrorCode::Cancelled, "stopped while quantising the parameters");
      }
    }
    return true;
  });
}

/// The model of a volume whose finite voxels are all equal: no step is needed to be exact.
ModelPointer ConstantModel(Model model, const glm::i64vec3& dims)
{
  model.parameters.assign(Layout(model.description).parameterCount, 0.0f);
  if (model.storedAs == ParameterType::Quantised) {
    // So many zeros that a reader refuses to unpack them have to be written out.
    const bool packs = MayExpand(0, PlainParameterBytes(model.parameters.size()));
    model.storedAs = packs ? ParameterType::Quantised : ParameterType::Half;
    model.steps.assign(packs ? ParameterGroups(model.description).size() : 0, 1.0f);
  }
  model.macroCells.provenance = MacroCellProvenance::Decoded;
  std::fill(model.macroCells.ranges.begin(), model.macroCells.ranges.end(), ValueRange{0, 0});
  // Whether there is a window without a gap is not worth a search.
  const bool windowFits = std::min({dims.x, dims.y, dims.z}) >= 7 && model.training->nonFinite == 0;
  model.quality = Quality{std::numeric_limits<double>::infinity(),
                          windowFits ? 1.0 : std::numeric_limits<double>::quiet_NaN(), 0.0};
  return std::make_shared<const Model>(std::move(model));
}

/// Voxels that are decoded in about a second: the larger the network, the fewer.
std::int64_t BandSize(const Description& description)
{
  constexpr std::uint64_t products = std::uint64_t{1} << 34;
  const std::uint64_t weights = std::max<std::uint64_t>(1, Layout(description).gridOffset);
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(products / weights), 1024, 1 << 20);
}

} // namespace

ModelPointer TrainModel(const VolumeData& volume, const VolumeInfo& info,
                        const TrainingOptions& options, const TrainingObserver& observer)
{
  CheckArguments(volume, options);
  const Arena arena(options.threads);
  const InstructionSet set = ChooseInstructionSet(options.kernel);
  const VolumeStatistics statistics = MeasureVolume(volume, arena);
  if (statistics.nonFinite == volume.voxels()) {
    throw Error(ErrorCode::InvalidArgument, "none of the " + std::to_string(volume.voxels()) +
                                                " values of array '" + info.arrayName +
                                                "' is finite");
  }
  const int macroCellSize =
      options.macroCellSize > 0 ? options.macroCellSize : DefaultMacroCellSize(volume.dims);

  Model model;
  model.description = options.description.value_or(ChooseDescription(
      volume.dims, volume.type, options.targetRatio, options.storedAs, macroCellSize));
  model.storedAs = options.storedAs;
  model.volume = info;
  model.volume.dims = volume.dims;
  model.volume.type = volume.type;
  model.volume.low = statistics.low;
  model.volume.high = statistics.high;
  model.training = TrainingRecord{0,
                                  0,
                                  options.seed,
                                  0.0,
                                  InstructionSetName(set),
                                  static_cast<std::uint64_t>(statistics.nonFinite),
                                  std::nullopt};
  model.macroCells = MakeMacroCells(volume.dims, macroCellSize);
  RequireStorable(model);
  if (!(statistics.low < statistics.high)) {
    return ConstantModel(std::move(model), volume.dims);
  }

  const InMemorySource source(volume, statistics.low, statistics.high);
  GradientDescent descent(model.description, options.seed, set, arena);
  StartFrom(options.start, model, descent);
  TrainingLoop loop(options, observer);
  StratifiedBatches batches(source);
  loop.run(descent, batches, PsnrEstimate(source, options.seed), EvaluateKernelFor(set));
  model.training->steps = descent.steps();
  model.training->plannedSteps = loop.plannedSteps();
  model.training->seconds = loop.seconds();
  model.parameters = descent.parameters();
  if (options.storedAs == ParameterType::Quantised) {
    // More voxels than while training: a tenth of a dB is to be told.
    const PsnrEstimate estimate(source, options.seed, 4 * PsnrEstimate::UsualVoxels);
    const double ratio = options.description ? 0.0 : options.targetRatio;
    Quantise(model, estimate, EvaluateKernelFor(set), LimitsForRatio(model, ratio),
             CheckOf(observer, descent.steps()));
  }
  RoundAsStored(model);

  const std::uint64_t steps = descent.steps();
  const auto trained = std::make_shared<Model>(std::move(model));
  const DecodedReport report = MeasureQuality(
      *MakeEvaluator(trained, options.kernel), volume, trained->volume, macroCellSize, arena,
      [&](double fraction) {
        return !observer || observer({TrainingPhase::Measuring,
                                      TrainingShare + (1.0 - TrainingShare) * fraction, steps, 0});
      },
      BandSize(trained->description));
  trained->quality = report.quality;
  trained->macroCells = report.macroCells;
  return trained;
}

} // namespace inr
