// SPDX-License-Identifier: BSD-3-Clause
//
// What a vtkINRWriter trains, by what, and what comes of it.
#include "CUDA/CudaTrainer.h"
#include "Core/Error.h"
#include "Core/Model/DescriptionJson.h"
#include "Core/Model/ModelFile.h"
#include "Core/Training/Parallel/ParallelTraining.h"
#include "Core/UsableMemory.h"
#include "Readers/Common/StopSignals.h"
#include "Readers/Common/VTKCompat.h"
#include "Readers/Training/ControllerGroup.h"
#include "Readers/Training/ParallelInput.h"
#include "Readers/Training/PipelineReader.h"
#include "Readers/Training/RawFiles.h"
#include "Readers/Training/TrainingCheckpoint.h"
#include "Readers/Training/TrainingInput.h"
#include "Readers/Training/TrainingReport.h"
#include "Readers/vtkINRWriterInternals.h"

#include <vtkImageData.h>
#include <vtkLogger.h>

#include <sstream>
#include <utility>

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

inr::ModelPointer vtkINRWriter::TrainAsRead(const ParallelInput& given,
                                            const inr::TrainingOptions& options,
                                            const ControllerGroup& group,
                                            const inr::TrainingObserver& observe)
{
  const TrainingInput& input = given.input;
  if (this->Internal->Reading.inPieces()) {
    return this->TrainInPieces(input, options, group, observe);
  }
  if (group.size() > 1) {
    return inr::TrainModel(given.piece(), input.info, options, group, observe);
  }
  return inr::TrainModel(input.data, input.info, options, observe);
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
  inr::TrainingOptions options = this->MakeOptions();
  options.threads = group.threads();
  options.memoryLimit = group.memoryShare(options.memoryLimit);
  options.start = this->FindStart(given.input.info);
  this->Internal->Previous = options.start; // also for another attempt, where this one fails
  TrainingCheckpoint checkpoint(this, this->Internal->Target, this->CheckpointInterval,
                                this->Resume);
  options.checkpoint = checkpoint.options();
  const std::shared_ptr<TrainingBackend> backend = this->FindBackend();
  options.acceleration = backend->options();
  const auto tell = [&] {
    checkpoint.tell();
    backend->tell(group.rank() == 0);
  };

  const std::string whole = this->Internal->Reading.whyWhole();
  if (!whole.empty() && group.rank() == 0) {
    this->WarnOfWhole(whole);
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
    model = this->TrainAsRead(given, options, group, observe);
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
  if (!model->volume.time) {
    this->Internal->Previous = nullptr;
  } else if (model->training->steps > 0) { // of a constant, the one before that says more
    this->Internal->Previous = model;
  }
  const bool showsHidden = group.any(this->Internal->ShowsHidden);
  if (group.rank() == 0) {
    this->WarnOfModel(*model, options, showsHidden);
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
