// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRDecode.h"

#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "LevelSampler.h"
#include "Scalars.h"
#include "VTKCompat.h"
#include "vtkINRDataArray.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRDecode);

namespace {

constexpr int EmptyExtent[6] = {0, -1, 0, -1, 0, -1};

vtkINRDataArray* FindModel(vtkDataObject* data)
{
  auto* image = vtkImageData::SafeDownCast(data);
  vtkDataArray* scalars = image ? image->GetPointData()->GetScalars() : nullptr;
  return scalars ? vtkINRDataArray::SafeDownCast(scalars) : nullptr;
}

/// Distance of the native voxels as the input has it now: a filter may have changed the image's.
glm::dvec3 NativeSpacing(vtkImageData* image, vtkINRDataArray* source)
{
  glm::dvec3 spacing;
  image->GetSpacing(&spacing.x);
  int presented[3];
  source->GetPresentedDimensions(presented);
  for (int axis = 0; axis < 3; ++axis) {
    if (presented[axis] > 1) {
      const auto cells = static_cast<double>(source->GetModel()->volume.dims[axis] - 1);
      spacing[axis] *= (presented[axis] - 1) / cells;
    }
  }
  return spacing;
}

/// The wanted voxels of a level's grid; an axis whose last voxel is below its first is whole.
/// Throws inr::Error when none of them is in the grid.
void LevelExtent(const glm::i64vec3& dims, const int wanted[6], int extent[6])
{
  for (int axis = 0; axis < 3; ++axis) {
    const int last = static_cast<int>(dims[axis] - 1); // the validator sees to it that it fits
    const int* range = wanted + 2 * axis;
    const bool whole = range[1] < range[0];
    if (!whole && (range[0] > last || range[1] < 0)) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "VolumeOfInterest asks for the voxels " + std::to_string(range[0]) + " to " +
                           std::to_string(range[1]) + " of an axis that has 0 to " +
                           std::to_string(last) + " at this Level");
    }
    extent[2 * axis] = whole ? 0 : std::clamp(range[0], 0, last);
    extent[2 * axis + 1] = whole ? last : std::clamp(range[1], 0, last);
  }
}

int TypeNumber(int wanted, inr::ScalarType source)
{
  return wanted < 0 ? VtkTypeOf(source) : wanted;
}

/// Refuses what the machine cannot hold: the kernel would grant it and then end the process.
void CheckMemory(const int extent[6], int type)
{
  double bytes = vtkDataArray::GetDataTypeSize(type);
  for (int axis = 0; axis < 3; ++axis) {
    bytes *= extent[2 * axis + 1] - extent[2 * axis] + 1;
  }
  vtksys::SystemInformation system;
  const double memory = 1024.0 * static_cast<double>(system.GetHostMemoryTotal());
  if (bytes > memory) {
    constexpr double mib = 1024.0 * 1024.0;
    throw inr::Error(inr::ErrorCode::TooLarge,
                     "the voxels take " + std::to_string(static_cast<long long>(bytes / mib)) +
                         " MiB and this machine has " +
                         std::to_string(static_cast<long long>(memory / mib)) +
                         "; choose a higher Level or a smaller VolumeOfInterest");
  }
}

} // namespace

int vtkINRDecode::RequestInformation(vtkInformation*, vtkInformationVector**,
                                     vtkInformationVector* outputVector)
{
  // The native grid is known to the model only, which travels with the data; a reader's data are
  // virtual, so updating it here costs next to nothing.
  this->GetInputAlgorithm(0, 0)->Update();
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  outInfo->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  try {
    if (this->DescribeOutput(outInfo)) {
      return 1;
    }
  } catch (const inr::Error& error) {
    vtkErrorMacro("Cannot decode: " << error.what());
  }
  outInfo->Set(Pipeline::WHOLE_EXTENT(), EmptyExtent, 6);
  return 1;
}

bool vtkINRDecode::DescribeOutput(vtkInformation* outInfo)
{
  auto* image = vtkImageData::SafeDownCast(this->GetInputDataObject(0, 0));
  vtkINRDataArray* source = FindModel(image);
  if (!source) {
    // Nothing in, nothing out: a reader that failed has said why.
    if (!image || image->GetNumberOfPoints() > 0) {
      vtkErrorMacro("The input is not an implicit neural representation; connect INRDecode to the "
                    "output of INRReader.");
    }
    return false;
  }
  const inr::VolumeInfo& volume = source->GetModel()->volume;
  const glm::i64vec3 dims = LevelDims(volume.dims, this->Level);
  const glm::dvec3 native = NativeSpacing(image, source);
  const glm::dvec3 growth = glm::dvec3(volume.dims) / glm::dvec3(dims);
  const glm::dvec3 spacing = native * growth;

  const glm::dvec3 shift = 0.5 * native * (growth - 1.0);
  glm::dvec3 origin;
  image->GetDirectionMatrix()->MultiplyPoint(&shift.x, &origin.x);
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] += image->GetOrigin()[axis];
  }
  int extent[6];
  LevelExtent(dims, this->VolumeOfInterest, extent);
  outInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::SPACING(), &spacing.x, 3);
  outInfo->Set(vtkDataObject::ORIGIN(), &origin.x, 3);
  outInfo->Set(vtkDataObject::DIRECTION(), image->GetDirectionMatrix()->GetData(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, TypeNumber(this->ScalarType, volume.type),
                                              1);
  return true;
}

int vtkINRDecode::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
                                      vtkInformationVector*)
{
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  inInfo->Set(Pipeline::UPDATE_EXTENT(), inInfo->Get(Pipeline::WHOLE_EXTENT()), 6);
  return 1;
}

int vtkINRDecode::RequestData(vtkInformation*, vtkInformationVector**,
                              vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  vtkImageData* output = vtkImageData::GetData(outInfo);
  output->Initialize();
  if (!FindModel(this->GetInputDataObject(0, 0))) {
    return 1; // RequestInformation has said so
  }
  try {
    int extent[6];
    outInfo->Get(Pipeline::UPDATE_EXTENT(), extent);
    if (extent[1] < extent[0] || extent[3] < extent[2] || extent[5] < extent[4]) {
      return 1; // RequestInformation has said why, or there are more processes than voxels
    }
    output->SetExtent(extent);
    output->SetSpacing(outInfo->Get(vtkDataObject::SPACING()));
    output->SetOrigin(outInfo->Get(vtkDataObject::ORIGIN()));
    output->SetDirectionMatrix(outInfo->Get(vtkDataObject::DIRECTION()));
    this->Decode(output);
  } catch (const std::exception& error) { // inr::Error, or no memory
    output->Initialize();
    vtkErrorMacro("Cannot decode: " << error.what());
  }
  return 1;
}

void vtkINRDecode::Decode(vtkImageData* output)
{
  auto* input = vtkImageData::SafeDownCast(this->GetInputDataObject(0, 0));
  const int type = TypeNumber(this->ScalarType, FindModel(input)->GetModel()->volume.type);
  if (!ScalarTypeOf(type)) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "ScalarType " + std::to_string(type) + " is not a type of numbers");
  }
  int extent[6];
  output->GetExtent(extent);
  CheckMemory(extent, type);
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  values->SetName(input->GetPointData()->GetScalars()->GetName());
  values->SetNumberOfTuples(output->GetNumberOfPoints());
  bool finished = false;
  switch (type) {
    vtkTemplateMacro(finished =
                         this->Fill(static_cast<VTK_TT*>(values->GetVoidPointer(0)), extent));
  }
  if (finished) {
    output->GetPointData()->SetScalars(values);
  } else {
    output->Initialize();
  }
}

bool vtkINRDecode::ShouldStop()
{
#ifdef INR_VTK_CHECK_ABORT
  return this->CheckAbort() || this->GetAbortExecute() != 0;
#else
  return this->GetAbortExecute() != 0;
#endif
}

template <class T> bool vtkINRDecode::Fill(T* values, const int extent[6])
{
  const inr::ModelPointer& model = FindModel(this->GetInputDataObject(0, 0))->GetModel();
  const auto evaluator = inr::MakeEvaluator(model);
  const inr::Arena arena;
  const LevelSampler sampler(model->volume, this->Level);
  const std::int64_t width = extent[1] - extent[0] + 1;
  const std::int64_t height = extent[3] - extent[2] + 1;
  const std::int64_t depth = extent[5] - extent[4] + 1;
  for (std::int64_t z = 0; z < depth && !this->ShouldStop(); ++z) {
    arena.forEachBlock(height, 1, [&](std::int64_t y, std::int64_t) {
      const inr::Lattice row = sampler.Row({extent[0], extent[2] + y, extent[4] + z}, width);
      std::vector<float> samples(
          static_cast<std::size_t>(row.points.x * row.points.y * row.points.z));
      inr::EvaluateLattice(*evaluator, arena, row, samples.data());
      T* out = values + width * (y + height * z);
      for (std::int64_t x = 0; x < width; ++x) {
        out[x] = ToScalar<T>(inr::ValueOf(model->volume, sampler.Average(samples, row, x)));
      }
    });
    this->UpdateProgress(static_cast<double>(z + 1) / static_cast<double>(depth));
  }
  return !this->ShouldStop();
}

void vtkINRDecode::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Level: " << this->Level << "\n"
     << indent << "ScalarType: " << this->ScalarType << "\n";
}
