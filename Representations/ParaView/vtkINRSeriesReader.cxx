// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRSeriesReader.h"

#include "SeriesTimes.h"
#include "vtkDataObject.h"
#include "vtkINRReader.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRSeriesReader);

namespace {

void MoveTimes(vtkInformation* from, vtkInformation* to)
{
  to->CopyEntry(from, Pipeline::TIME_STEPS()); // removes what `from` does not have
  to->CopyEntry(from, Pipeline::TIME_RANGE());
}

} // namespace

vtkINRSeriesReader::vtkINRSeriesReader() = default;
vtkINRSeriesReader::~vtkINRSeriesReader() = default;

void vtkINRSeriesReader::LookIntoFiles()
{
  this->Times.clear();
  this->Readable.clear();
  auto* reader = vtkINRReader::SafeDownCast(this->Reader);
  const unsigned int files = this->GetNumberOfFileNames();
  if (!reader || files < 2) { // the only one's time would have it drawn anew for every other time
    return;
  }
  for (unsigned int k = 0; k < files; ++k) {
    double time = 0;
    const bool readable = reader->FindTime(this->GetFileName(k), time);
    this->Times.push_back(time);
    this->Readable.push_back(readable);
  }
  this->Times = inr::SeriesTimes(this->Times);
}

int vtkINRSeriesReader::RequestInformation(vtkInformation* request, vtkInformationVector** inputs,
                                           vtkInformationVector* outputs)
{
  this->LookIntoFiles();
  this->IsListing = true;
  this->Superclass::RequestInformation(request, inputs, outputs);
  this->IsListing = false;
  // What is known of the volume is that of the step which is shown, if there is one.
  vtkInformation* outInfo = outputs->GetInformationObject(0);
  vtkNew<vtkInformation> times;
  MoveTimes(outInfo, times);
  const int result =
      this->RequestInformationForInput(this->FindStepToTellOf(outInfo), request, outputs);
  MoveTimes(times, outInfo);
  return result;
}

int vtkINRSeriesReader::FindStepToTellOf(vtkInformation* outInfo)
{
  const int shown = this->GetNumberOfFileNames() > 0 ? this->ChooseInput(outInfo) : 0;
  if (this->Readable.empty() || this->Readable[static_cast<std::size_t>(shown)]) {
    return shown;
  }
  const auto found = std::find(this->Readable.begin(), this->Readable.end(), true);
  return found == this->Readable.end() ? shown : static_cast<int>(found - this->Readable.begin());
}

int vtkINRSeriesReader::RequestInformationForInput(int index, vtkInformation* request,
                                                   vtkInformationVector* outputVector)
{
  if (!this->IsListing) {
    return this->Superclass::RequestInformationForInput(index, request, outputVector);
  }
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  if (static_cast<std::size_t>(index) < this->Times.size()) {
    const double time = this->Times[static_cast<std::size_t>(index)];
    const double range[2] = {time, time};
    outInfo->Set(Pipeline::TIME_STEPS(), &time, 1);
    outInfo->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

int vtkINRSeriesReader::RequestData(vtkInformation* request, vtkInformationVector** inputs,
                                    vtkInformationVector* outputs)
{
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  vtkInformation* outInfo = outputs->GetInformationObject(0);
  vtkDataObject* output = vtkDataObject::GetData(outInfo);
  if (output && outInfo->Has(Pipeline::TIME_STEPS()) &&
      outInfo->Has(Pipeline::UPDATE_TIME_STEP())) {
    // The last step that is not later than what was asked for, as the superclass chooses it.
    const double* steps = outInfo->Get(Pipeline::TIME_STEPS());
    const double* end = steps + outInfo->Length(Pipeline::TIME_STEPS());
    const double* later = std::upper_bound(steps, end, outInfo->Get(Pipeline::UPDATE_TIME_STEP()));
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(),
                                  later == steps ? *steps : *(later - 1));
  }
  return result;
}

void vtkINRSeriesReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Times: " << this->Times.size() << " told by files\n";
}
