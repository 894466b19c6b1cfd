// SPDX-License-Identifier: BSD-3-Clause
//
// What a vtkINRWriter trains, by what, and what comes of it.
#include "CUDA/CudaTrainer.h"
#include "ControllerGroup.h"
#include "Core/Error.h"
#include "Core/Model/DescriptionJson.h"
#include "Core/Model/ModelFile.h"
#include "Core/Training/ParallelTraining.h"
#include "Core/Training/TargetReport.h"
#include "Core/UsableMemory.h"
#include "ParallelInput.h"
#include "PipelineReader.h"
#include "RawFiles.h"
#include "StopSignals.h"
#include "TrainingCheckpoint.h"
#include "TrainingInput.h"
#include "TrainingReport.h"
#include "VTKCompat.h"
#include "WriterInternals.h"

#include <vtkImageData.h>
#include <vtkLogger.h>

#include <sstream>
#include <utility>

namespace {

constexpr std::int64_t MiB = std::int64_t{1} << 20;

} // namespace

std::int64_t vtkINRWriter::MemoryLimitInBytes() const
{
  return this->MemoryLimit > 0 ? MiB * this->MemoryLimit : inr::UsableMemory() / 2;
}

inr::ModelPointer vtkINRWriter::FindStart(const inr::VolumeInfo& volume) const
{
  const inr::ModelPointer& previous = this->Internal->Previous;
  const bool follows = previous && volume.time && volume.time != previous->volume.time &&
                       volume.arrayName == previous->volume.arrayName;
  return this->StartFromPrevious && follows ? previous : nullptr;
}

inr::TrainingOptions vtkINRWriter::MakeOptions() const
{
  inr::TrainingOptions options;
  options.targetPsnr = this->TargetPSNR;
  options.targetRatio = this->TargetRatio;
  options.maximumSteps = static_cast<std::uint64_t>(this->MaximumSteps);
  options.timeLimit = this->TimeLimit;
  options.plannedSteps = static_cast<std::uint64_t>(this->PlannedSteps);
  options.seed = static_cast<std::uint64_t>(this->Seed);
  options.macroCellSize = this->MacroCellSize;
  options.storedAs =
      this->ReadableByInstantVNR ? inr::ParameterType::Half : inr::ParameterType::Quantised;
  if (this->ModelConfig && *this->ModelConfig) {
    options.description = inr::ParseModelConfig(this->ModelConfig);
  }
  options.memoryLimit = this->MemoryLimitInBytes();
  return options;
}

void vtkINRWriter::WarnOfWhole(const std::string& source)
{
  vtkWarningMacro(<< source << " of '" << this->Internal->Target
                  << "' cannot give parts of its data: all of them, "
                  << this->Internal->Reading.whole().bytes / MiB
                  << " MiB, are in memory, more than half of the MemoryLimit of "
                  << this->MemoryLimitInBytes() / MiB << " MiB.");
}

/// Where that is not what TargetRatio asks for.
void vtkINRWriter::WarnOfLargeFile(const inr::Model& model)
{
  constexpr double wellBelow = 0.9;
  const bool isAsked = !(this->ModelConfig && *this->ModelConfig); // which overrides it
  if (isAsked && this->Ratio < wellBelow * this->TargetRatio) {
    vtkWarningMacro("The file '" << this->Internal->Target << "' is " << this->Ratio
                                 << " times smaller than the data, not " << this->TargetRatio
                                 << " times (TargetRatio): a model of " << model.parameters.size()
                                 << " parameters and the ranges of "
                                 << model.macroCells.ranges.size() << " macro-cells take more"
                                 << (this->MacroCellSize > 0
                                         ? "; a larger MacroCellSize gives fewer ranges."
                                         : "."));
  }
}

/// Where the limit made the default model smaller.
void vtkINRWriter::WarnOfSmallModel(const inr::Model& model, const inr::TrainingOptions& options)
{
  if (options.description || options.targetRatio > 0) {
    return; // that is the one
  }
  const inr::VolumeInfo& volume = model.volume;
  const inr::Description usual =
      inr::ChooseDescription(volume.dims, volume.type, 0, options.storedAs, options.macroCellSize);
  if (!(model.description == usual)) {
    vtkWarningMacro("The MemoryLimit of "
                    << this->MemoryLimitInBytes() / MiB << " MiB left '" << this->Internal->Target
                    << "' a model of " << inr::Layout(model.description).parameterCount
                    << " parameters instead of " << inr::Layout(usual).parameterCount
                    << ", which costs quality; raise it to have the usual one.");
  }
}

inr::ModelPointer vtkINRWriter::TrainInPieces(const TrainingInput& first,
                                              const inr::TrainingOptions& options,
                                              const ControllerGroup& group,
                                              const inr::TrainingObserver& observe)
{
  const WholeImage& whole = this->Internal->Reading.whole();
  if (group.rank() == 0) {
    vtkLog(INFO, << this->Internal->Target << ": the data take " << whole.bytes / MiB
                 << " MiB and are read in pieces, within " << options.memoryLimit / MiB << " MiB"
                 << (group.size() > 1 ? " in each process" : ""));
  }
  auto* image = vtkImageData::SafeDownCast(this->GetInput());
  const auto find = [this](vtkImageData* piece) { return this->FindInput(piece); };
  const RawFiles files(this);
  PipelineReader reader(*this, whole, *image, find, group.size() > 1);
  try {
    return inr::TrainModel(reader, first.info, options, group, observe);
  } catch (const inr::Error& error) {
    throw files.complete(error);
  }
}

void vtkINRWriter::SetBackend(int backend)
{
  if (backend < AUTO || backend > CUDA) {
    vtkErrorMacro("Backend " << backend << " is none of 0 (Auto), 1 (CPU), 2 (CUDA).");
    return;
  }
  this->Internal->Beside.reset();
  if (this->Backend != backend) {
    this->Backend = backend;
    this->Modified();
  }
}

std::shared_ptr<const inr::TrainingAccelerator>
vtkINRWriter::FindTrainingAccelerator(std::string& reason)
{
  inr::cuda::FoundTrainer found = inr::cuda::FindTrainer(0); // a process alone
  reason = found.reason;
  return found.accelerator;
}

std::shared_ptr<TrainingBackend> vtkINRWriter::FindBackend()
{
  std::shared_ptr<TrainingBackend>& beside = this->Internal->Beside;
  if (!beside) {
    std::string reason;
    auto accelerator = this->Backend == CPU ? nullptr : this->FindTrainingAccelerator(reason);
    beside = std::make_shared<TrainingBackend>(this, std::move(accelerator), reason,
                                               this->Backend == CUDA);
  }
  return beside;
}

void vtkINRWriter::Train(const ParallelInput& given, const StopSignals& signals,
                         const ControllerGroup& group)
{
  const TrainingInput& input = given.input;
  inr::TrainingOptions options = this->MakeOptions();
  options.threads = group.threads();
  options.memoryLimit = group.memoryShare(options.memoryLimit);
  options.start = this->FindStart(input.info);
  this->Internal->Previous = nullptr;
  TrainingCheckpoint checkpoint(this, this->Internal->Target, this->CheckpointInterval,
                                this->Resume);
  options.checkpoint = checkpoint.options();
  const std::shared_ptr<TrainingBackend> backend = this->FindBackend();
  options.acceleration = backend->options();
  const auto tell = [&] {
    checkpoint.tell();
    backend->tell(group.rank() == 0);
  };

  const ReadingPlan& reading = this->Internal->Reading;
  if (!reading.wholeReader().empty() && group.rank() == 0) {
    this->WarnOfWhole(reading.wholeReader());
  }
  TrainingReport report;
  const auto observe = [&](const inr::TrainingProgress& progress) {
    this->SetProgressText(report.text(progress).c_str());
    this->UpdateProgress(progress.fraction);
    tell();
    return !signals.Received() && !IsAborted(*this);
  };
  inr::ModelPointer model;
  try {
    if (reading.inPieces()) {
      model = this->TrainInPieces(input, options, group, observe);
    } else if (group.size() > 1) {
      model = inr::TrainModel(given.piece(), input.info, options, group, observe);
    } else {
      model = inr::TrainModel(input.data, input.info, options, observe);
    }
    vtkIdType bytes = 0;
    group.together(
        [&] { bytes = group.rank() == 0 ? inr::WriteModel(*model, this->Internal->Target) : 0; });
    this->KeepResult(*model, group.valueOfFirst(bytes));
  } catch (const inr::Error& error) {
    tell();
    throw checkpoint.complete(error);
  }
  tell();
  checkpoint.remove(group.rank());
  this->UpdateProgress(1.0);
  this->Internal->Previous = model->volume.time ? model : nullptr;
  if (group.rank() == 0) {
    this->WarnOfLargeFile(*model);
  }
  if (reading.inPieces() && group.rank() == 0) {
    this->WarnOfSmallModel(*model, options);
  }
  if (model->training->nonFinite > 0 && group.rank() == 0) {
    vtkWarningMacro(
        "Array '" << input.info.arrayName << "' has " << model->training->nonFinite
                  << " NaN or infinite values, or hidden points; they were left out of "
                     "the training, and what the model shows there is made up. To hide it "
                     "later, give them a value outside of the data's range before "
                     "saving (Calculator; of hidden points, then PassArrays).");
  }
  const std::string missing = inr::ShortOfTarget(*model, options);
  if (!missing.empty() && group.rank() == 0) {
    vtkWarningMacro("Of '" << this->Internal->Target << "' " << missing << ".");
  }
  if (group.any(this->Internal->ShowsHidden) && group.rank() == 0) {
    vtkWarningMacro("Some points of array '"
                    << input.info.arrayName
                    << "' are hidden, but a model has no mask and integers no NaN: their values "
                       "are shown like all others. Make the array a float or double one "
                       "(Calculator, Result Array Type) to leave them out of the training.");
  }
}

void vtkINRWriter::KeepResult(const inr::Model& model, vtkIdType fileSize)
{
  const glm::dvec3 dims(model.volume.dims);
  const double bytes =
      dims.x * dims.y * dims.z * static_cast<double>(inr::ScalarSize(model.volume.type));
  this->PSNR = model.quality->psnr;
  this->SSIM = model.quality->ssim;
  this->MaximumError = model.quality->maxError;
  this->Ratio = bytes / static_cast<double>(fileSize);
  this->Steps = static_cast<vtkIdType>(model.training->steps);
  this->TrainingSeconds = model.training->seconds;
  this->BackendInUse = BackendText(*model.training);
  this->WaitingSeconds = model.training->waitingSeconds;
  this->ExchangeSeconds = model.training->exchangeSeconds;
  if (ControllerGroup(this->Internal->Controller).rank() > 0) {
    return; // the first one says so
  }
  std::ostringstream training;
  if (this->Steps > 0) {
    training << this->Steps << " steps in " << this->TrainingSeconds << " s by "
             << this->BackendInUse << TimesOfGroup(*model.training);
  } else {
    training << "no training, as all values are equal";
  }
  vtkLog(INFO, << this->Internal->Target << ": PSNR " << this->PSNR << " dB, SSIM " << this->SSIM
               << ", largest error " << this->MaximumError << ", ratio " << this->Ratio << ", "
               << training.str());
}
