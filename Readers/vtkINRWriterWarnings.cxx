// SPDX-License-Identifier: BSD-3-Clause
//
// What a vtkINRWriter tells of a model that is not what its user may take it for.
#include "Core/Training/TargetReport.h"
#include "Readers/vtkINRWriterInternals.h"

void vtkINRWriter::WarnOfWhole(const std::string& why)
{
  vtkWarningMacro(<< why << ": what '" << this->Internal->Target << "' is made of, "
                  << this->Internal->Reading.whole().bytes / MiB
                  << " MiB, is in memory, more than half of the MemoryLimit of "
                  << this->MemoryLimitInBytes() / MiB << " MiB.");
}

/// Where that is not what TargetRatio asks for, or the data themselves take less.
void vtkINRWriter::WarnOfLargeFile(const inr::Model& model)
{
  constexpr double wellBelow = 0.9;
  const bool hasConfig = this->ModelConfig && *this->ModelConfig; // which overrides the ratio
  const double asked = hasConfig ? 0 : this->TargetRatio;
  if (this->Ratio < wellBelow * asked) {
    vtkWarningMacro("The file '" << this->Internal->Target << "' is " << this->Ratio
                                 << " times smaller than the data, not " << asked
                                 << " times (TargetRatio): a model of " << model.parameters.size()
                                 << " parameters and the ranges of "
                                 << model.macroCells.ranges.size() << " macro-cells take more"
                                 << (this->MacroCellSize > 0
                                         ? "; a larger MacroCellSize gives fewer ranges."
                                         : "."));
  } else if (this->Ratio < 1 && !(asked > 0)) {
    vtkWarningMacro(
        "The file '" << this->Internal->Target << "' is " << 1 / this->Ratio
                     << " times as large as the data: a model pays where these are much larger, or "
                        "with "
                     << (hasConfig ? "a smaller ModelConfig"
                                   : "a TargetRatio that makes it smaller")
                     << (this->ReadableByInstantVNR ? ", or without ReadableByInstantVNR." : "."));
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

void vtkINRWriter::WarnOfModel(const inr::Model& model, const inr::TrainingOptions& options,
                               bool showsHidden)
{
  const std::string& array = model.volume.arrayName;
  this->WarnOfLargeFile(model);
  if (this->Internal->Reading.inPieces()) {
    this->WarnOfSmallModel(model, options);
  }
  if (model.training->nonFinite > 0) {
    vtkWarningMacro(
        "Array '" << array << "' has " << model.training->nonFinite
                  << " NaN or infinite values, or hidden points; they were left out of "
                     "the training, and what the model shows there is made up. To hide it "
                     "later, give them a value outside of the data's range before "
                     "saving (Calculator; of hidden points, then PassArrays).");
  }
  const std::string missing = inr::ShortOfTarget(model, options);
  if (!missing.empty()) {
    vtkWarningMacro("Of '" << this->Internal->Target << "' " << missing << ".");
  }
  if (showsHidden) {
    vtkWarningMacro("Some points of array '"
                    << array
                    << "' are hidden, but a model has no mask and integers no NaN: their values "
                       "are shown like all others. Make the array a float or double one "
                       "(Calculator, Result Array Type) to leave them out of the training.");
  }
}
