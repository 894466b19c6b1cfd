// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTurbulentChannelSource.h"

#include "Core/Error.h"
#include "Testing/Turbulence/ChannelGrid.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

vtkStandardNewMacro(vtkTurbulentChannelSource);

namespace {
using Pipeline = vtkStreamingDemandDrivenPipeline;
constexpr const char* ArrayName = "velocity";
} // namespace

vtkTurbulentChannelSource::vtkTurbulentChannelSource() { this->SetNumberOfInputPorts(0); }
vtkTurbulentChannelSource::~vtkTurbulentChannelSource() = default;

int vtkTurbulentChannelSource::RequestInformation(vtkInformation*, vtkInformationVector**,
                                                  vtkInformationVector* outputs)
{
  vtkInformation* const output = outputs->GetInformationObject(0);
  int extent[6];
  double spacing[3];
  double origin[3];
  for (int axis = 0; axis < 3; ++axis) {
    extent[2 * axis] = 0;
    extent[2 * axis + 1] = this->Dimensions[axis] - 1;
    spacing[axis] = inr::TurbulentChannel::Size[axis] / std::max(1, this->Dimensions[axis]);
    origin[axis] = 0.5 * spacing[axis];
  }
  output->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  output->Set(vtkDataObject::SPACING(), spacing, 3);
  output->Set(vtkDataObject::ORIGIN(), origin, 3);
  output->Set(CAN_PRODUCE_SUB_EXTENT(), 1);
  vtkDataObject::SetPointDataActiveScalarInfo(output, this->OutputScalarType, 1);
  output->Remove(Pipeline::TIME_STEPS());
  output->Remove(Pipeline::TIME_RANGE());
  if (this->NumberOfTimeSteps > 1) {
    std::vector<double> times;
    for (int step = 0; step < this->NumberOfTimeSteps; ++step) {
      times.push_back(step * this->TimeStepSize);
    }
    const double range[] = {times.front(), times.back()};
    output->Set(Pipeline::TIME_STEPS(), times.data(), this->NumberOfTimeSteps);
    output->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

int vtkTurbulentChannelSource::RequestData(vtkInformation*, vtkInformationVector**,
                                           vtkInformationVector* outputs)
{
  vtkInformation* const output = outputs->GetInformationObject(0);
  try {
    this->Compute(output);
  } catch (const inr::Error& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  } catch (const std::bad_alloc&) {
    vtkErrorMacro("there is no memory for the extent asked for; ask for a smaller one");
    vtkImageData::GetData(output)->Initialize();
    return 0;
  }
  return 1;
}

// The step at or before the time asked for, the first one before that.
double vtkTurbulentChannelSource::TimeAsked(vtkInformation* output) const
{
  if (this->NumberOfTimeSteps == 1 || !output->Has(Pipeline::UPDATE_TIME_STEP())) {
    return 0;
  }
  const double asked = output->Get(Pipeline::UPDATE_TIME_STEP());
  double time = 0;
  for (int step = 1; step < this->NumberOfTimeSteps && step * this->TimeStepSize <= asked; ++step) {
    time = step * this->TimeStepSize;
  }
  return time;
}

// Its tables are as much work as a small extent.
void vtkTurbulentChannelSource::PrepareGrid(double time)
{
  if (this->Grid && this->GridMade == this->GetMTime() && this->GridTime == time) {
    return;
  }
  inr::TurbulentChannel::Parameters parameters;
  parameters.seed = static_cast<std::uint64_t>(this->Seed);
  parameters.octaves = this->Octaves;
  parameters.intensity = this->Intensity;
  parameters.time = time;
  this->Grid = std::make_unique<const inr::ChannelGrid>(
      inr::TurbulentChannel(parameters),
      glm::i64vec3(this->Dimensions[0], this->Dimensions[1], this->Dimensions[2]));
  this->GridMade = this->GetMTime();
  this->GridTime = time;
}

void vtkTurbulentChannelSource::Compute(vtkInformation* output)
{
  const double time = this->TimeAsked(output);
  this->PrepareGrid(time);
  int extent[6];
  output->Get(Pipeline::UPDATE_EXTENT(), extent);
  vtkImageData* const image = vtkImageData::GetData(output);
  image->SetExtent(extent);
  image->AllocateScalars(output);
  vtkDataArray* const array = image->GetPointData()->GetScalars();
  array->SetName(ArrayName);
  image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  this->Count(array->GetNumberOfTuples() * array->GetDataTypeSize());

  const inr::Arena arena(this->NumberOfThreads);
  const glm::i64vec3 begin(extent[0], extent[2], extent[4]);
  const glm::i64vec3 size = glm::i64vec3(extent[1], extent[3], extent[5]) - begin + std::int64_t{1};
  void* const values = array->GetVoidPointer(0);
  if (this->OutputScalarType == VTK_DOUBLE) {
    this->Grid->box(arena, begin, size, static_cast<double*>(values));
  } else {
    this->Grid->box(arena, begin, size, static_cast<float*>(values));
  }
}

void vtkTurbulentChannelSource::Count(vtkIdType bytes)
{
  ++this->NumberOfRequests;
  this->LargestRequest = std::max(this->LargestRequest, bytes);
  this->BytesRequested += bytes;
}

void vtkTurbulentChannelSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Dimensions: " << this->Dimensions[0] << " " << this->Dimensions[1] << " "
     << this->Dimensions[2] << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Octaves: " << this->Octaves << "\n";
  os << indent << "Intensity: " << this->Intensity << "\n";
  os << indent << "OutputScalarType: " << vtkImageScalarTypeNameMacro(this->OutputScalarType)
     << "\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
  os << indent << "TimeStepSize: " << this->TimeStepSize << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "LargestRequest: " << this->LargestRequest << " bytes of "
     << this->NumberOfRequests << "\n";
}
