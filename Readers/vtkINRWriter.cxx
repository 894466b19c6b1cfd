// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRWriter.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/Model/DescriptionJson.h"
#include "Core/Model/ModelFile.h"
#include "Core/Training/Trainer.h"
#include "StopSignals.h"
#include "TrainingInput.h"
#include "VTKCompat.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkLogger.h>
#include <vtkObjectFactory.h>

#include <exception>
#include <string>

vtkStandardNewMacro(vtkINRWriter);

vtkINRWriter::vtkINRWriter()
{
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::SCALARS);
}

vtkINRWriter::~vtkINRWriter()
{
  delete[] this->FileName;
  delete[] this->ModelConfig;
}

int vtkINRWriter::FillInputPortInformation(int, vtkInformation* info)
{
  // Anything may be connected, so that what is not image data gets our message, not the pipeline's.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

void vtkINRWriter::WriteData()
{
  this->ForgetResult();
  const StopSignals signals; // hands a signal on, which may end the process, after our message
  try {
    if (!this->FileName || !*this->FileName) {
      throw inr::Error(inr::ErrorCode::InvalidArgument, "no FileName is set");
    }
    const TrainingInput input = this->FindInput();
    {
      // Learn that the target is not writable now, not after minutes of training.
      const inr::AtomicFile attempt{std::string(this->FileName)};
    }
    this->Train(input, signals);
  } catch (const std::exception& error) { // inr::Error, or no memory
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkErrorMacro("Cannot save '" << (this->FileName ? this->FileName : "")
                                  << "' as an implicit neural representation: " << error.what());
  }
}

TrainingInput vtkINRWriter::FindInput()
{
  vtkDataObject* data = this->GetInput();
  auto* image = vtkImageData::SafeDownCast(data);
  if (!image) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     std::string("the data set is a ") + (data ? data->GetClassName() : "null") +
                         ", not image data; resample it with ResampleToImage first");
  }
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkAbstractArray* array = this->GetInputAbstractArrayToProcess(0, image, association);
  if (!array) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "the image has no such point array, or none is chosen");
  }
  const std::string name = array->GetName() ? array->GetName() : "";
  if (association != vtkDataObject::FIELD_ASSOCIATION_POINTS) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "array '" + name +
                         "' is not point data; if it is cell data, use "
                         "CellDataToPointData first");
  }
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, "array '" + name + "' is a " +
                                                          array->GetClassName() +
                                                          ", which does not hold numbers");
  }
  return MakeTrainingInput(image, numbers);
}

void vtkINRWriter::Train(const TrainingInput& input, const StopSignals& signals)
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
    options.description = inr::ParseDescription(std::string(this->ModelConfig));
  }

  const auto observe = [&](const inr::TrainingProgress& progress) {
    const bool training = progress.phase == inr::TrainingPhase::Training;
    this->SetProgressText(training ? "Training INR" : "Measuring INR quality");
    this->UpdateProgress(progress.fraction);
    return !signals.Received() && !IsAborted(*this);
  };
  const inr::ModelPointer model = inr::TrainModel(input.data, input.info, options, observe);
  this->KeepResult(*model, inr::WriteModel(*model, this->FileName));
  this->UpdateProgress(1.0);
  if (model->training->nonFinite > 0) {
    vtkWarningMacro("Array '" << input.info.arrayName << "' has " << model->training->nonFinite
                              << " NaN or infinite values; they were left out of the training.");
  }
}

void vtkINRWriter::ForgetResult()
{
  this->PSNR = this->SSIM = this->MaximumError = this->Ratio = this->TrainingSeconds = 0;
  this->Steps = 0;
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
  vtkLog(INFO, << this->FileName << ": PSNR " << this->PSNR << " dB, SSIM " << this->SSIM
               << ", largest error " << this->MaximumError << ", ratio " << this->Ratio << ", "
               << this->Steps << " steps in " << this->TrainingSeconds << " s");
}

void vtkINRWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "TargetPSNR: " << this->TargetPSNR << "\n"
     << indent << "TargetRatio: " << this->TargetRatio << "\n"
     << indent << "MaximumSteps: " << this->MaximumSteps << "\n"
     << indent << "TimeLimit: " << this->TimeLimit << "\n"
     << indent << "MacroCellSize: " << this->MacroCellSize << "\n"
     << indent << "PlannedSteps: " << this->PlannedSteps << "\n"
     << indent << "Seed: " << this->Seed << "\n"
     << indent << "ModelConfig: " << (this->ModelConfig ? this->ModelConfig : "(chosen)") << "\n"
     << indent << "ReadableByInstantVNR: " << (this->ReadableByInstantVNR ? "on" : "off") << "\n";
}
