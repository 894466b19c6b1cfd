// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRDecode.h"

#include "Core/Cache/LevelVoxels.h"
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Readers/Common/Extents.h"
#include "Readers/Common/MemoryCheck.h"
#include "Readers/Common/StopSignals.h"
#include "Readers/Common/VTKCompat.h"
#include "Readers/Grid/NativeGrid.h"
#include "Readers/Grid/Scalars.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRDecode);

namespace {

/// Rows of voxels that one thread decodes at a time.
constexpr std::int64_t RowsPerTask = 8;

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

/// Refuses what the machine cannot hold.
void CheckMemory(const int extent[6], int type)
{
  double bytes = vtkDataArray::GetDataTypeSize(type);
  for (int axis = 0; axis < 3; ++axis) {
    bytes *= extent[2 * axis + 1] - extent[2 * axis] + 1;
  }
  RequireMemory(bytes, "the voxels", "choose a higher Level or a smaller VolumeOfInterest");
}

void RequireSameGrid(const int known[6], const int found[6])
{
  if (!std::equal(known, known + 6, found)) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "this time step has more or fewer voxels than the one that was there first; "
                     "open its file alone");
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
  if (vtkCompositeDataSet::SafeDownCast(this->GetInputDataObject(0, 0))) {
    return 1; // the pipeline asks of each block afterwards
  }
  outInfo->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  try {
    if (this->DescribeOutput(outInfo)) {
      return 1;
    }
  } catch (const std::exception& error) { // inr::Error, or no memory
    vtkErrorMacro("Cannot decode: " << error.what());
  }
  outInfo->Set(Pipeline::WHOLE_EXTENT(), NoVoxels, 6);
  return 1;
}

bool vtkINRDecode::DescribeOutput(vtkInformation* outInfo)
{
  const auto grid = FindInputGrid(this, this->GetInputDataObject(0, 0));
  if (!grid) {
    return false;
  }
  const inr::VolumeInfo& volume = grid->model->volume;
  const LevelGrid level(*grid, this->Level);
  const glm::dvec3 spacing = grid->spacing * level.growth;
  int extent[6];
  LevelExtent(level.dims, this->VolumeOfInterest, extent);
  outInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::SPACING(), &spacing.x, 3);
  outInfo->Set(vtkDataObject::ORIGIN(), &level.origin.x, 3);
  auto* image = vtkImageData::SafeDownCast(this->GetInputDataObject(0, 0));
  outInfo->Set(vtkDataObject::DIRECTION(), image->GetDirectionMatrix()->GetData(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, TypeNumber(this->ScalarType, volume.type),
                                              1);
  return true;
}

int vtkINRDecode::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
                                      vtkInformationVector*)
{
  RequestWholeInput(inputVector[0]->GetInformationObject(0));
  return 1;
}

int vtkINRDecode::RequestData(vtkInformation*, vtkInformationVector**,
                              vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  vtkImageData* output = vtkImageData::GetData(outInfo);
  output->Initialize();
  const auto grid = FindNativeGrid(this->GetInputDataObject(0, 0));
  if (!grid) {
    return 1; // RequestInformation has said so
  }
  const StopSignals signals;
  try {
    int extent[6];
    outInfo->Get(Pipeline::UPDATE_EXTENT(), extent);
    if (IsEmpty(extent)) {
      return 1; // RequestInformation has said why, or there are more processes than voxels
    }
    vtkNew<vtkInformation> step; // the pipeline knows the grid of one time step only
    this->DescribeOutput(step);
    RequireSameGrid(outInfo->Get(Pipeline::WHOLE_EXTENT()), step->Get(Pipeline::WHOLE_EXTENT()));
    output->SetExtent(extent);
    output->SetSpacing(step->Get(vtkDataObject::SPACING()));
    output->SetOrigin(step->Get(vtkDataObject::ORIGIN()));
    output->SetDirectionMatrix(step->Get(vtkDataObject::DIRECTION()));
    this->Decode(*grid, output, signals);
  } catch (const std::exception& error) { // inr::Error, or no memory
    output->Initialize();
    vtkErrorMacro("Cannot decode: " << error.what());
  }
  return 1;
}

void vtkINRDecode::Decode(const NativeGrid& grid, vtkImageData* output, const StopSignals& signals)
{
  const int type = TypeNumber(this->ScalarType, grid.model->volume.type);
  if (!ScalarTypeOf(type)) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "ScalarType " + std::to_string(type) + " is not a type of numbers");
  }
  int extent[6];
  output->GetExtent(extent);
  CheckMemory(extent, type);
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  values->SetName(grid.arrayName.c_str());
  RequireRoom(static_cast<std::size_t>(output->GetNumberOfPoints()) *
              static_cast<std::size_t>(values->GetDataTypeSize()));
  values->SetNumberOfTuples(output->GetNumberOfPoints());
  const auto stop = [&] { return signals.Received() || IsAborted(*this); };
  bool finished = false;
  switch (type) {
    vtkTemplateMacro(
        finished = this->Fill(grid, extent, static_cast<VTK_TT*>(values->GetVoidPointer(0)), stop));
  }
  if (finished) {
    output->GetPointData()->SetScalars(values);
  } else {
    output->Initialize();
  }
}

template <class T, class Stop>
bool vtkINRDecode::Fill(const NativeGrid& grid, const int extent[6], T* values, const Stop& stop)
{
  const auto evaluator = inr::MakeEvaluator(grid.model);
  const inr::Arena arena;
  const inr::VolumeInfo& volume = grid.model->volume;
  const inr::LevelVoxels voxels(*grid.model, this->Level);
  const std::int64_t width = extent[1] - extent[0] + 1;
  const std::int64_t height = extent[3] - extent[2] + 1;
  const std::int64_t depth = extent[5] - extent[4] + 1;
  for (std::int64_t z = 0; z < depth; ++z) {
    arena.forEachBlock(height, RowsPerTask, [&](std::int64_t y, std::int64_t end) {
      const std::vector<float> box =
          voxels.in({{extent[0], extent[2] + y, extent[4] + z}, {width, end - y, 1}}, *evaluator);
      std::transform(box.begin(), box.end(), values + width * (y + height * z),
                     [&](float value) { return ToScalar<T>(inr::ValueOf(volume, value)); });
    });
    this->UpdateProgress(static_cast<double>(z + 1) / static_cast<double>(depth));
    if (stop()) {
      return false;
    }
  }
  return true;
}

void vtkINRDecode::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const int* voi = this->VolumeOfInterest;
  os << indent << "VolumeOfInterest: " << voi[0] << " " << voi[1] << " " << voi[2] << " " << voi[3]
     << " " << voi[4] << " " << voi[5] << "\n"
     << indent << "Level: " << this->Level << "\n"
     << indent << "ScalarType: " << this->ScalarType << "\n";
}
