// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Grid/NativeGrid.h"

#include "Core/Cache/BrickKey.h"
#include "vtkINRDataArray.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace {

/// Distance of the native voxels where the presented points stand as they do in `image`.
glm::dvec3 SpacingOf(vtkImageData* image, const vtkINRDataArray& source)
{
  glm::dvec3 spacing;
  image->GetSpacing(&spacing.x);
  int presented[3];
  source.GetPresentedDimensions(presented);
  for (int axis = 0; axis < 3; ++axis) {
    if (presented[axis] > 1) {
      const auto cells = static_cast<double>(source.GetModel()->volume.dims[axis] - 1);
      spacing[axis] *= (presented[axis] - 1) / cells;
    }
  }
  return spacing;
}

} // namespace

LevelGrid::LevelGrid(const NativeGrid& native, int level)
    : dims(inr::VoxelsAtLevel(native.model->volume.dims, level)),
      growth(glm::dvec3(native.model->volume.dims) / glm::dvec3(this->dims)),
      origin(native.origin + native.Axes() * (0.5 * (this->growth - 1.0)))
{}

std::optional<NativeGrid> FindNativeGrid(vtkDataObject* data)
{
  auto* image = vtkImageData::SafeDownCast(data);
  vtkAbstractArray* array = image ? vtkINRDataArray::FindIn(image->GetPointData()) : nullptr;
  if (!array) {
    return std::nullopt;
  }
  const vtkINRDataArray& source = *vtkINRDataArray::SafeDownCast(array);
  NativeGrid grid;
  grid.model = source.GetModel();
  grid.arrayName = array->GetName() ? array->GetName() : "";
  int first[3];
  source.GetShift(image, first);
  image->TransformIndexToPhysicalPoint(first, &grid.origin.x);
  grid.spacing = SpacingOf(image, source);
  grid.direction = glm::transpose(glm::make_mat3(image->GetDirectionMatrix()->GetData()));
  return grid;
}

std::optional<NativeGrid> FindInputGrid(vtkAlgorithm* filter, vtkDataObject* data)
{
  std::optional<NativeGrid> grid = FindNativeGrid(data);
  auto* image = vtkImageData::SafeDownCast(data);
  if (!grid && (!image || image->GetNumberOfPoints() > 0)) {
    vtkErrorWithObjectMacro(filter, "The input is not an implicit neural representation; connect "
                                    "this filter to the output of INRReader.");
  }
  return grid;
}

void RequestWholeInput(vtkInformation* inInfo)
{
  inInfo->Set(Pipeline::UPDATE_EXTENT(), inInfo->Get(Pipeline::WHOLE_EXTENT()), 6);
  inInfo->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
  inInfo->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  inInfo->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
}
