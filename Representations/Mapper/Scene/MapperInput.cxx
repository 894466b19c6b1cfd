// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/MapperInput.h"

#include "vtkINRDataArray.h"

#include <vtkAbstractArray.h>
#include <vtkImageData.h>
#include <vtkVolumeMapper.h>

namespace inr {
namespace {

/// The one of the points that the mapper is told to draw, if there is one.
vtkAbstractArray* SelectedArray(vtkVolumeMapper* mapper, vtkImageData* image)
{
  int whose = 0;
  vtkAbstractArray* array = vtkAbstractMapper::GetAbstractScalars(
      image, mapper->GetScalarMode(), mapper->GetArrayAccessMode(), mapper->GetArrayId(),
      mapper->GetArrayName(), whose);
  constexpr int ofPoints = 0; // as VTK counts here, 1 are the cells and 2 the data set itself
  return whose == ofPoints ? array : nullptr;
}

std::string NotAnInr(vtkAbstractArray* array)
{
  if (!array) {
    return "The input has no point scalars to draw; choose the INR's array, or connect a "
           "vtkINRReader.";
  }
  return std::string("The input's array '") + (array->GetName() ? array->GetName() : "") +
         "' is not an INR (a filter may have turned it into ordinary voxels); show the reader "
         "itself, or this as \"Volume\" (in VTK: connect a vtkINRReader, or use another volume "
         "mapper).";
}

} // namespace

MapperInput FindInput(vtkVolumeMapper* mapper)
{
  MapperInput result;
  result.grid.image = vtkImageData::SafeDownCast(mapper->GetDataSetInput());
  if (!result.grid.image) {
    result.problem = "The input is not image data; connect a vtkINRReader.";
    return result;
  }
  vtkAbstractArray* array = SelectedArray(mapper, result.grid.image);
  result.array = vtkINRDataArray::SafeDownCast(array);
  if (!result.array || !result.array->GetModel()) {
    result.array = nullptr;
    result.problem = NotAnInr(array);
    return result;
  }
  int presented[3];
  result.array->GetPresentedDimensions(presented);
  result.grid.presented = glm::ivec3(presented[0], presented[1], presented[2]);
  int shift[3];
  result.array->GetShift(result.grid.image, shift);
  result.grid.shift = glm::ivec3(shift[0], shift[1], shift[2]);
  result.grid.native = result.array->GetModel()->volume.dims;
  return result;
}

} // namespace inr
