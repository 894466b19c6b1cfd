// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/TrainingRun.h"

#include "Core/Error.h"
#include "Core/Inference/EvaluateKernel.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/CompactBlobs.h"
#include "Core/Model/Compression.h"
#include "Core/Model/ModelFile.h"
#include "Core/Model/Quantised.h"
#include "Core/NumberText.h"
#include "Core/Timer.h"
#include "Core/Training/Descent/AcceleratedDescent.h"
#include "Core/Training/Quality/Ssim.h"
#include "Core/Training/Quantise.h"
#include "Core/Training/Runtime/NoMemory.h"
#include "Core/Training/TrainingIdentity.h"
#include "Core/Training/TrainingLoop.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <string>
#include <utility>

namespace inr {

namespace {

/// Of a model that has the same value everywhere.
ValueRange OnlyRangeOf(const ModelPointer& model)
{
  const glm::vec3 anywhere(0.5f);
  float value = 0;
  MakeEvaluator(model)->evaluate(&anywhere, 1, &value);
  value = NormalisedOutput(value);
  return {value, value};
}

/// Whether a network as it is says something of these data. Where it is as far from them as a
/// constant, as of structures that have moved by more than their size, it takes longer to unlearn
/// than to learn, and its units may all be turned off on the way. Of 15 series of trainings of 200
/// steps, those that began with less than 0.6 of a constant's squared error had -3 to +8 dB for it
/// after nine of them, most of them more; all that began with more than 0.8 had less.
bool IsWorthMore(const ModelView& model, const PsnrEstimate& estimate, const EvaluateKernel& kernel)
{
  constexpr double share = 0.7; // of what a constant leaves
  const double error = estimate.squaredError(estimate.values(model, kernel, StopCheck()));
  return estimate.known() == 0 || error < share * estimate.squaredErrorOfConstant();
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

/// One that all processes have: the same gradients then lead to the same parameters.
InstructionSet CommonInstructionSet(const std::string& kernel, const TrainingGroup& group)
{
  const std::vector<InstructionSet> all = group.valuesOfAll(ChooseInstructionSet(kernel));
  return *std::min_element(all.begin(), all.end());
}

} // namespace

void CheckArguments(const glm::i64vec3& dims, const TrainingOptions& options)
{
  if (dims.x < 1 || dims.y < 1 || dims.z < 1) {
    throw Error(ErrorCode::InvalidArgument, "there are no voxels to train on");
  }
  for (const auto& [name, value] : {std::pair("TargetPSNR", options.targetPsnr),
                                    {"TargetRatio", options.targetRatio},
                                    {"TimeLimit", options.timeLimit}}) {
    if (!std::isfinite(value) || value < 0) { // an infinite one would pass for a limit below
      throw Error(ErrorCode::InvalidArgument, std::string(name) + " is " + NumberText(value) +
                                                  "; set a finite positive number, or 0 for none");
    }
  }
  constexpr int largestEdge = 1 << 29; // so that a single layer's spacing can be told in a file
  const int edge = options.macroCellSize;
  if (edge < 0 || edge > largestEdge || (edge & (edge - 1)) != 0) {
    throw Error(ErrorCode::InvalidArgument,
                "MacroCellSize is " + std::to_string(edge) + "; set a power of two up to " +
                    std::to_string(largestEdge) + ", or 0 for the default");
  }
  const bool limited = options.targetPsnr > 0 || options.maximumSteps > 0 || options.timeLimit > 0;
  if (!limited) {
    throw Error(ErrorCode::InvalidArgument,
                "training would never end: set TargetPSNR, MaximumSteps or TimeLimit");
  }
}

int MacroCellSizeOf(const VolumeInfo& volume, const TrainingOptions& options)
{
  return options.macroCellSize > 0 ? options.macroCellSize : DefaultMacroCellSize(volume.dims);
}

std::int64_t BandSize(const Description& description)
{
  constexpr std::uint64_t products = std::uint64_t{1} << 34;
  const std::uint64_t weights = std::max<std::uint64_t>(1, Layout(description).gridOffset);
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(products / weights), 1024, 1 << 20);
}

TrainingRun::TrainingRun(const VolumeInfo& info, const VolumeStatistics& statistics,
                         const TrainingOptions& options, const TrainingObserver& observer,
                         const TrainingGroup* group)
    : Options(options), Observer(observer), Together(group),
      Set(CommonInstructionSet(options.kernel, this->group())),
      MacroCellSize(MacroCellSizeOf(info, options)),
      ConstantError(statistics.isConstant() ? statistics.distance() : 0.0)
{
  if (!statistics.hasValues()) {
    throw Error(ErrorCode::InvalidArgument, "none of the " + std::to_string(statistics.nonFinite) +
                                                " values of array '" + info.arrayName +
                                                "' is finite");
  }
  Model& model = this->Result;
  model.description = options.description.value_or(ChooseDescription(
      info.dims, info.type, options.targetRatio, options.storedAs, this->MacroCellSize));
  model.storedAs = options.storedAs;
  model.volume = info;
  const bool constant = statistics.isConstant();
  model.volume.low = constant ? statistics.nearest() : statistics.low;
  model.volume.high = constant ? statistics.nearest() : statistics.high;
  model.training = TrainingRecord{0,
                                  0,
                                  options.seed,
                                  0.0,
                                  InstructionSetName(this->Set),
                                  static_cast<std::uint64_t>(statistics.nonFinite),
                                  std::nullopt};
  model.macroCells = MakeMacroCells(info.dims, this->MacroCellSize);
  RequireStorable(model);
}

TrainingRun::~TrainingRun() = default; // where GradientDescent is known

bool TrainingRun::isConstant() const
{
  return !(this->Result.volume.low < this->Result.volume.high);
}

ModelPointer TrainingRun::constantModel()
{
  Model& model = this->Result;
  model.parameters.assign(Layout(model.description).parameterCount, 0.0f);
  if (model.storedAs == ParameterType::Quantised) {
    // So many zeros that a reader refuses to unpack them have to be written out.
    const bool packs = MayExpand(0, PlainParameterBytes(model.parameters.size()));
    model.storedAs = packs ? ParameterType::Quantised : ParameterType::Half;
    model.steps.assign(packs ? ParameterGroups(model.description).size() : 0, 1.0f);
  }
  const glm::i64vec3 dims = model.volume.dims;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const bool exact = this->ConstantError == 0; // or there is no range to compare errors with
  // Whether there is a window without a gap is not worth a search.
  const bool windowFits = exact && SliceSsim::HasWindows(dims) && model.training->nonFinite == 0;
  model.quality = Quality{exact ? std::numeric_limits<double>::infinity() : unknown,
                          windowFits ? 1.0 : unknown, this->ConstantError};
  const auto made = std::make_shared<Model>(std::move(model));
  made->macroCells.provenance = MacroCellProvenance::Decoded;
  std::fill(made->macroCells.ranges.begin(), made->macroCells.ranges.end(), OnlyRangeOf(made));
  return made;
}

TrainingIdentity TrainingRun::identity(const PsnrEstimate& estimate,
                                       const BatchSource& batches) const
{
  return IdentityOf(this->Result, this->Options, estimate, batches, this->group().size());
}

void TrainingRun::train(BatchSource& batches, const PsnrEstimate& estimate, const Arena& arena)
{
  try {
    this->takeSteps(batches, estimate, arena);
  } catch (const std::bad_alloc&) { // before the first step, or while the steps were written
    throw NoMemoryToTrain();
  }
}

void TrainingRun::takeSteps(BatchSource& batches, const PsnrEstimate& estimate, const Arena& arena)
{
  Model& model = this->Result;
  auto steps =
      std::make_unique<GradientDescent>(model.description, this->Options.seed, this->Set, arena);
  GradientDescent& host = *steps;
  this->startFromOther(host, estimate);
  host.share(this->group());
  const auto accelerated = this->accelerate(host, batches, arena);
  Descent& descent = accelerated ? static_cast<Descent&>(*accelerated) : host;
  const bool draws = accelerated && accelerated->drawsSamples();
  model.training->pipeline = draws ? TrainingPipeline::DeviceMemory : batches.pipeline();
  if (accelerated) { // what the checkpoint is of
    model.training->kernel = this->Options.acceleration.accelerator->kernel();
  }
  const bool first = this->group().rank() == 0;
  this->Keeper.emplace(first ? this->Options.checkpoint : CheckpointOptions(),
                       this->identity(estimate, batches));
  TrainingLoop loop(this->Options, this->Observer, *this->Keeper, this->group(),
                    model.training->pipeline);
  loop.run(descent, batches, estimate, EvaluateKernelFor(this->Set));
  this->End = loop.state(descent, true);
  if (this->Keeper->isDone()) {
    model.parameters = std::move(descent.parameters());
  } else {
    descent.parameters(); // to the host
    host.freeWorkspace();
    this->Steps = std::move(steps);
  }
  model.training->steps = descent.steps();
  if (loop.beganAnew()) {
    model.training->earlierSteps.reset();
  }
  model.training->plannedSteps = loop.plannedSteps();
  model.training->seconds = loop.seconds();
  model.training->waitingSeconds = host.exchangeTimes().waiting;
  model.training->exchangeSeconds = host.exchangeTimes().exchanging;
  this->record(accelerated.get());
}

/// Goes on from the start's parameters where these fit, which is then on record.
void TrainingRun::startFromOther(GradientDescent& descent, const PsnrEstimate& estimate)
{
  const ModelPointer& start = this->Options.start;
  Model& model = this->Result;
  if (!start || !(start->description == model.description)) {
    return;
  }
  descent.startFrom(start->parameters);
  const EvaluateKernel& kernel = EvaluateKernelFor(this->Set);
  bool isWorthMore = false;
  this->group().together([&] { isWorthMore = IsWorthMore(descent.view(), estimate, kernel); });
  if (!this->group().valueOfFirst(isWorthMore)) {
    descent.startAnew(this->Options.seed);
    return;
  }
  const TrainingRecord before = start->training.value_or(TrainingRecord());
  model.training->earlierSteps = before.steps + before.earlierSteps.value_or(0);
}

void TrainingRun::keepSteps(const std::function<void()>& work)
{
  try {
    work();
  } catch (const Error& error) {
    StopTraining(error, this->group(), [this] { return this->writeSteps(); });
  } catch (const std::bad_alloc&) { // nor do other processes know of it
    const Error error = NoMemoryBesideSteps();
    throw Error(error.code(), error.what() + ("; " + this->writeSteps()));
  } catch (...) {
    this->writeSteps();
    throw;
  }
}

/// Says, for the user, what is kept.
std::string TrainingRun::writeSteps()
{
  return this->Keeper->writeAtStop(this->End, this->Steps ? this->Steps->state() : StateArrays());
}

/// Null where the CPU trains alone, which is told where there is an accelerator.
std::unique_ptr<AcceleratedDescent>
TrainingRun::accelerate(GradientDescent& host, const BatchSource& batches, const Arena& arena) const
{
  const AccelerationOptions& options = this->Options.acceleration;
  const auto tell = [&options](AccelerationEvent event, const std::string& text) {
    options.tell ? options.tell(event, text) : void();
  };
  if (!options.accelerator) {
    return nullptr;
  }
  if (this->group().size() > 1) {
    tell(AccelerationEvent::NotUsed, "several processes train together, which only the CPU does");
    return nullptr;
  }
  try {
    const TrainingTask task{this->Result.description, batches.count(), host.stream(),
                            batches.inMemory()};
    return std::make_unique<AcceleratedDescent>(
        host, options.accelerator->start(task), arena,
        [tell](const std::string& text) { tell(AccelerationEvent::Failed, text); });
  } catch (const Error& error) {
    tell(AccelerationEvent::NotUsed, error.what());
    return nullptr;
  }
}

/// What has trained.
void TrainingRun::record(const AcceleratedDescent* accelerated)
{
  TrainingRecord& record = *this->Result.training;
  const std::string kernel = InstructionSetName(this->Set);
  record.kernel = kernel;
  record.backend = "CPU " + kernel;
  if (accelerated != nullptr && accelerated->hasUsedDevice()) {
    const TrainingAccelerator& device = *this->Options.acceleration.accelerator;
    const bool toTheEnd = accelerated->isAccelerated();
    record.kernel = device.kernel() + (toTheEnd ? "" : ", then " + kernel);
    record.backend = device.name() + (toTheEnd ? "" : ", then CPU " + kernel);
  }
}

std::shared_ptr<Model> TrainingRun::store(const PsnrEstimate& estimate)
{
  if (this->Steps) {
    this->Result.parameters = this->Steps->parameters();
  }
  if (this->Options.storedAs == ParameterType::Quantised) {
    const double ratio = this->Options.description ? 0.0 : this->Options.targetRatio;
    Quantise(this->Result, estimate, EvaluateKernelFor(this->Set),
             LimitsForRatio(this->Result, ratio), this->storingCheck());
    // So many may turn out so equal that no reader would unpack them.
    if (this->Result.storedAs == ParameterType::Quantised && !IsReadableQuantised(this->Result)) {
      this->Result.storedAs = ParameterType::Half;
      this->Result.steps.clear();
    }
  }
  RoundAsStored(this->Result);
  return std::make_shared<Model>(std::move(this->Result));
}

/// Lets the observer stop what comes between training and measuring.
StopCheck TrainingRun::storingCheck() const
{
  return StopCheck([this, clock = Timer(), last = 0.0]() mutable {
    constexpr double interval = 0.2; // seconds
    if (this->Observer && clock.seconds() - last >= interval) {
      last = clock.seconds();
      const std::uint64_t steps = this->Result.training->steps;
      if (!this->Observer({TrainingPhase::Measuring, TrainingShare, steps, 0})) {
        throw Error(ErrorCode::Cancelled, "stopped while quantising the parameters");
      }
    }
    return true;
  });
}

} // namespace inr
