// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRDecode.h"

#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
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

glm::i64vec3 LevelDims(glm::i64vec3 dims, int level)
{
  for (; level > 0; --level) {
    dims = (dims + std::int64_t{1}) / std::int64_t{2};
  }
  return dims;
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

/// The samples of a row-major run of voxels: one per voxel on level 0, else two per axis, which
/// `Average` joins.
struct LevelSampler
{
  LevelSampler(const inr::VolumeInfo& volume, int level)
      : Dims(LevelDims(volume.dims, level)), PerAxis(1)
  {
    for (int axis = 0; axis < 3; ++axis) {
      this->PerAxis[axis] = level > 0 && volume.dims[axis] > 1 ? 2 : 1;
    }
  }

  inr::Lattice Row(const glm::i64vec3& first, std::int64_t count) const
  {
    inr::Lattice lattice;
    lattice.step = 1.0 / (glm::dvec3(this->Dims) * glm::dvec3(this->PerAxis));
    lattice.first = (glm::dvec3(first * this->PerAxis) + 0.5) * lattice.step;
    lattice.points = glm::i64vec3(count, 1, 1) * this->PerAxis;
    return lattice;
  }

  float Average(const std::vector<float>& samples, const inr::Lattice& row, std::int64_t x) const
  {
    double sum = 0;
    for (std::int64_t k = 0; k < row.points.z; ++k) {
      for (std::int64_t j = 0; j < row.points.y; ++j) {
        for (std::int64_t i = 0; i < this->PerAxis.x; ++i) {
          const std::int64_t at = x * this->PerAxis.x + i + row.points.x * (j + row.points.y * k);
          sum += inr::NormalisedOutput(samples[static_cast<std::size_t>(at)]);
        }
      }
    }
    return static_cast<float>(
        sum / static_cast<double>(this->PerAxis.x * this->PerAxis.y * this->PerAxis.z));
  }

  glm::i64vec3 Dims;
  glm::i64vec3 PerAxis;
};

} // namespace

int vtkINRDecode::RequestInformation(vtkInformation*, vtkInformationVector**,
                                     vtkInformationVector* outputVector)
{
  // The native grid is known to the model only, which travels with the data; a reader's data are
  // virtual, so updating it here costs next to nothing.
  this->GetInputAlgorithm(0, 0)->Update();
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  if (!this->DescribeOutput(outInfo)) {
    outInfo->Set(Pipeline::WHOLE_EXTENT(), EmptyExtent, 6);
  }
  return 1;
}

bool vtkINRDecode::DescribeOutput(vtkInformation* outInfo)
{
  vtkINRDataArray* source = FindModel(this->GetInputDataObject(0, 0));
  if (!source) {
    vtkErrorMacro("The input is not an implicit neural representation; connect INRDecode to the "
                  "output of INRReader.");
    return false;
  }
  auto* image = vtkImageData::SafeDownCast(this->GetInputDataObject(0, 0));
  const inr::VolumeInfo& volume = source->GetModel()->volume;
  const glm::i64vec3 dims = LevelDims(volume.dims, this->Level);
  int presented[3];
  source->GetPresentedDimensions(presented);
  int extent[6];
  double spacing[3];
  double shift[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int last = static_cast<int>(std::min<std::int64_t>(dims[axis], VTK_INT_MAX)) - 1;
    const int* wanted = this->VolumeOfInterest + 2 * axis;
    const bool whole = wanted[1] < wanted[0];
    extent[2 * axis] = whole ? 0 : std::clamp(wanted[0], 0, last);
    extent[2 * axis + 1] = whole ? last : std::clamp(wanted[1], 0, last);
    const auto voxels = static_cast<double>(volume.dims[axis]);
    const double native = presented[axis] > 1
                              ? image->GetSpacing()[axis] * (presented[axis] - 1) / (voxels - 1)
                              : image->GetSpacing()[axis];
    const double growth = voxels / static_cast<double>(dims[axis]);
    spacing[axis] = native * growth;
    shift[axis] = native * 0.5 * (growth - 1.0);
  }
  double origin[3];
  image->GetDirectionMatrix()->MultiplyPoint(shift, origin);
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] += image->GetOrigin()[axis];
  }
  outInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
  outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
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
