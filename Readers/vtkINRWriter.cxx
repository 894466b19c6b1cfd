// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRWriter.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Readers/Common/StopSignals.h"
#include "Readers/Training/ControllerGroup.h"
#include "Readers/Training/ParallelInput.h"
#include "Readers/Training/RawFiles.h"
#include "Readers/Training/TrainingInput.h"
#include "Readers/Training/Upstream.h"
#include "Readers/vtkINRWriterInternals.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRWriter);

namespace {

/// The step that the input is asked for, of so many, where it is one of several.
StepsToRead PresentStep(vtkInformation* input)
{
  const int count = input->Length(Pipeline::TIME_STEPS());
  if (count < 2 || !input->Has(Pipeline::UPDATE_TIME_STEP())) {
    return {};
  }
  const double* times = input->Get(Pipeline::TIME_STEPS());
  const double* later =
      std::upper_bound(times, times + count, input->Get(Pipeline::UPDATE_TIME_STEP()));
  const auto number = static_cast<int>(std::max<std::ptrdiff_t>(later - times - 1, 0));
  return {{number}, static_cast<std::size_t>(count)};
}

} // namespace

vtkINRWriter::vtkINRWriter() : Internal(std::make_unique<Internals>())
{
  this->vtkINRWriter::SetFileNameSuffix("_%d");
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::SCALARS);
}

vtkINRWriter::~vtkINRWriter()
{
  delete[] this->FileName;
  delete[] this->ModelConfig;
  delete[] this->FileNameSuffix;
}

int vtkINRWriter::FillInputPortInformation(int, vtkInformation* info)
{
  // Anything may be connected, so that what is not image data gets our message, not the pipeline's.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkINRWriter::ProcessRequest(vtkInformation* request, vtkInformationVector** inputs,
                                         vtkInformationVector* outputs)
{
  vtkInformation* input = inputs[0]->GetInformationObject(0);
  StepSequence& steps = this->Internal->Steps;
  if (input && request->Has(Pipeline::REQUEST_INFORMATION()) && !this->Internal->IsWriting) {
    this->PlanSteps(input);
  }
  const vtkTypeBool result = this->Superclass::ProcessRequest(request, inputs, outputs);
  if (input && request->Has(Pipeline::REQUEST_UPDATE_EXTENT())) {
    try {
      const ControllerGroup group(this->Internal->Controller);
      this->Internal->Reading =
          ReadingPlan(this, input, this->MemoryLimitInBytes(), this->Internal->MayProbe, group);
    } catch (const std::exception& error) { // other processes cannot be reached
      this->Internal->Problem = error.what();
    }
    if (!steps.isEmpty()) {
      input->Set(Pipeline::UPDATE_TIME_STEP(), steps.time());
    }
  }
  return result;
}

void vtkINRWriter::PlanSteps(vtkInformation* input)
{
  this->Internal->Steps = StepSequence();
  this->Internal->Problem.clear();
  const int count = this->WriteTimeSteps ? input->Length(Pipeline::TIME_STEPS()) : 0;
  if (count < 2) {
    return; // the present state is all there is
  }
  this->Internal->Previous = nullptr; // a series does not depend on what was written before it
  const double* times = input->Get(Pipeline::TIME_STEPS());
  try {
    this->Internal->Steps =
        StepSequence(std::vector<double>(times, times + count), this->MinTimeStep,
                     this->MaxTimeStep, this->TimeStepStride);
  } catch (const std::exception& error) {   // inr::Error, or no memory
    this->Internal->Problem = error.what(); // to be told when it is to be written
  }
}

int vtkINRWriter::Write()
{
  if (this->GetNumberOfInputConnections(0) < 1) {
    return this->Superclass::Write(); // says so
  }
  const StopSignals signals; // of all steps, and while a source reads, which does not look at them
  Internals& self = *this->Internal;
  this->SetErrorCode(vtkErrorCode::NoError);
  self.Beside.reset();
  this->BeginFile();
  self.IsWriting = false;
  this->Modified(); // so that the steps are planned anew
  const bool isKnown = this->GetExecutive()->UpdateInformation() != 0;
  this->Attempt([&] {
    this->RequireOfAll(isKnown);
    this->RequireSameSteps();
  });
  if (this->GetErrorCode() != vtkErrorCode::NoError || !this->CheckFiles(self.Steps.numbers())) {
    return 0;
  }
  self.IsWriting = true;
  // One update for each: a pipeline that goes on by itself does so for ever where a source fails.
  do {
    this->WriteStep();
  } while (this->GetErrorCode() == vtkErrorCode::NoError && self.Steps.advance() &&
           this->CheckFiles({self.Steps.number()}));
  self.IsWriting = false;
  self.Steps.rewind();
  this->SetProgressShiftScale(0.0, 1.0);
  return this->GetErrorCode() == vtkErrorCode::NoError ? 1 : 0;
}

/// The present step, or state.
void vtkINRWriter::WriteStep()
{
  Internals& self = *this->Internal;
  const double begin = self.Steps.progress(0.0);
  this->SetProgressShiftScale(begin, self.Steps.progress(1.0) - begin);
  self.Reading = ReadingPlan();
  self.IsReached = false;
  self.MayProbe = true;
  this->Superclass::Write();
  self.MayProbe = false;
  std::unique_ptr<UpstreamErrors> whyNoVoxel;
  if (self.Reading.isUnanswered()) { // who cannot give a voxel may give all
    whyNoVoxel = self.Reading.takeErrors();
    whyNoVoxel->endWatch();
    this->Superclass::Write();
  }
  if (!self.IsReached) {
    if (whyNoVoxel) {
      whyNoVoxel->show();
    }
    this->Attempt([&] { this->RequireOfAll(false); });
  }
}

/// That the source did what it was asked for. Where it failed in one process, the others would go
/// on and wait for that one for ever; so all make this call, one way or another.
void vtkINRWriter::RequireOfAll(bool succeeded)
{
  ControllerGroup(this->Internal->Controller).together([&] {
    if (!succeeded) {
      throw inr::Error(inr::ErrorCode::CannotRead, "the source failed; what it reported says why");
    }
  });
}

/// Processes may find different time steps, as of a series that is still being written: those with
/// fewer of them would finish while the others wait for ever. Of the ones to be saved.
void vtkINRWriter::RequireSameSteps()
{
  const Internals& self = *this->Internal;
  const ControllerGroup group(self.Controller);
  const std::vector<double> mine = self.Steps.times();
  const std::string bytes(reinterpret_cast<const char*>(mine.data()), mine.size() * sizeof(double));
  const std::string first = group.fromFirst(bytes);
  group.together([&] {
    if (!self.Problem.empty()) {
      throw inr::Error(inr::ErrorCode::InvalidArgument, self.Problem);
    }
    if (bytes.size() != first.size()) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "there are " + std::to_string(mine.size()) +
                           " time steps to save here and " +
                           std::to_string(first.size() / sizeof(double)) +
                           " in the first process; save them when all processes see the same");
    }
    if (bytes != first) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "the time steps to save are at other times here than in the first process");
    }
  });
}

/// Before the pipeline asks for these time steps, or for the present state: there are readers that
/// would not come back.
bool vtkINRWriter::CheckFiles(const std::vector<int>& steps)
{
  this->Attempt([&] {
    const ControllerGroup group(this->Internal->Controller);
    group.together([] {
      if (StopSignals::Received()) {
        throw inr::Error(inr::ErrorCode::Cancelled, "stopped before it was read");
      }
    });
    vtkInformation* input = this->GetInputInformation();
    const StepsToRead files =
        steps.empty() ? PresentStep(input) : StepsToRead{steps, this->Internal->Steps.available()};
    const std::string problem = FindFileProblem(this, input, files, steps.empty(), group);
    if (!problem.empty()) {
      throw inr::Error(inr::ErrorCode::CannotRead, problem);
    }
  });
  return this->GetErrorCode() == vtkErrorCode::NoError;
}

/// Tells the user of what `act` throws.
void vtkINRWriter::Attempt(const std::function<void()>& act)
{
  try {
    act();
  } catch (const std::exception& error) { // inr::Error, or no memory
    this->SetErrorCode(vtkErrorCode::UserError);
    if (ControllerGroup(this->Internal->Controller).rank() == 0) { // others say the same
      vtkErrorMacro("Cannot save '" << this->Internal->Target
                                    << "' as an implicit neural representation: " << error.what());
    }
  }
}

void vtkINRWriter::WriteData()
{
  this->BeginFile();
  this->Internal->IsReached = true;
  const StopSignals signals; // hands a signal on, which may end the process, after our message
  this->Attempt([&] { this->WriteInput(signals); });
}

void vtkINRWriter::WriteInput(const StopSignals& signals)
{
  this->RequireOfAll(true);
  ReadingPlan& reading = this->Internal->Reading;
  auto errors = reading.takeErrors();
  std::string& fileName = this->Internal->Target;
  if (fileName.empty()) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, "no FileName is set");
  }
  for (const std::string& problem : {this->Internal->Problem, reading.problem()}) {
    if (!problem.empty()) {
      throw inr::Error(inr::ErrorCode::InvalidArgument, problem);
    }
  }
  const StepSequence& steps = this->Internal->Steps;
  if (!steps.isEmpty()) {
    const std::string suffix = this->FileNameSuffix ? this->FileNameSuffix : "";
    fileName = StepFileName(fileName, suffix, steps.number());
  }
  const ControllerGroup group(this->Internal->Controller);
  ParallelInput input = reading.find(
      this->GetInput(), std::move(errors),
      [this](vtkDataObject* data) { return this->FindInput(data); }, group);
  if (!steps.isEmpty()) {
    input.input.info.time = steps.time();
  }
  group.together([&] {
    if (group.rank() == 0) {
      inr::RemoveAbandonedFiles(fileName);
      // Learn that the target is not writable now, not after minutes of training.
      const inr::AtomicFile attempt(fileName);
    }
  });
  this->Train(input, signals, group);
}

bool vtkINRWriter::IsMask(const char* name) { return ::IsMask(name); }

TrainingInput vtkINRWriter::FindInput(vtkDataObject* data)
{
  auto* image = vtkImageData::SafeDownCast(data);
  if (!image) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     std::string("the data set is a ") + (data ? data->GetClassName() : "null") +
                         ", not image data; resample it with ResampleToImage first");
  }
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkAbstractArray* array = this->GetInputAbstractArrayToProcess(0, image, association);
  // Where nobody has seen the data, nobody could choose.
  const char* chosen = this->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  if (!(chosen && *chosen) && (!array || IsMask(array->GetName()))) {
    array = DefaultArray(*image->GetPointData());
  }
  if (!array) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, NoSuchArray(*image, chosen));
  }
  const std::string name = array->GetName() ? array->GetName() : "";
  if (association != vtkDataObject::FIELD_ASSOCIATION_POINTS) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "array '" + name +
                         "' is not point data; if it is cell data, use "
                         "CellDataToPointData first");
  }
  TrainingInput input = MakeTrainingInput(image, array);
  this->Internal->ShowsHidden |= input.showsHidden;
  return input;
}

void vtkINRWriter::SetController(vtkMultiProcessController* controller)
{
  if (this->Internal->Controller != controller) {
    this->Internal->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkINRWriter::GetController() { return this->Internal->Controller; }

/// Nothing is achieved yet.
void vtkINRWriter::BeginFile()
{
  this->Internal->Target = this->FileName ? this->FileName : "";
  this->Internal->ShowsHidden = false;
  this->PSNR = this->SSIM = this->MaximumError = this->Ratio = 0;
  this->TrainingSeconds = this->WaitingSeconds = this->ExchangeSeconds = 0;
  this->Steps = 0;
  this->BackendInUse.clear();
}

void vtkINRWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "TargetPSNR: " << this->TargetPSNR << "\n"
     << indent << "TargetRatio: " << this->TargetRatio << "\n"
     << indent << "MaximumSteps: " << this->MaximumSteps << "\n"
     << indent << "TimeLimit: " << this->TimeLimit << "\n"
     << indent << "CheckpointInterval: " << this->CheckpointInterval << "\n"
     << indent << "Resume: " << (this->Resume ? "on" : "off") << "\n"
     << indent << "MemoryLimit: " << this->MemoryLimit << "\n"
     << indent << "MacroCellSize: " << this->MacroCellSize << "\n"
     << indent << "PlannedSteps: " << this->PlannedSteps << "\n"
     << indent << "Seed: " << this->Seed << "\n"
     << indent << "Backend: " << this->Backend << "\n"
     << indent << "ModelConfig: " << (this->ModelConfig ? this->ModelConfig : "(chosen)") << "\n"
     << indent << "ReadableByInstantVNR: " << (this->ReadableByInstantVNR ? "on" : "off") << "\n"
     << indent << "WriteTimeSteps: " << (this->WriteTimeSteps ? "on" : "off") << "\n"
     << indent << "FileNameSuffix: " << (this->FileNameSuffix ? this->FileNameSuffix : "") << "\n"
     << indent << "MinTimeStep: " << this->MinTimeStep << "\n"
     << indent << "MaxTimeStep: " << this->MaxTimeStep << "\n"
     << indent << "TimeStepStride: " << this->TimeStepStride << "\n"
     << indent << "StartFromPrevious: " << (this->StartFromPrevious ? "on" : "off") << "\n";
}
