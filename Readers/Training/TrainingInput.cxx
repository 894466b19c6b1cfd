// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/TrainingInput.h"

#include "Core/Error.h"
#include "Core/NumberText.h"
#include "Readers/Grid/Scalars.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace {

void Require(bool condition, const std::string& message)
{
  if (!condition) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, message);
  }
}

vtkSmartPointer<vtkDataArray> Contiguous(vtkDataArray* array)
{
  if (array->HasStandardMemoryLayout()) {
    return array;
  }
  auto copy =
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
  copy->DeepCopy(array);
  return copy;
}

bool IsHidden(const vtkUnsignedCharArray& ghosts, vtkIdType point)
{
  return (ghosts.GetValue(point) & vtkDataSetAttributes::HIDDENPOINT) != 0;
}

/// Makes NaNs of hidden points' values, in a copy of the image's `own`; of integers, says that
/// there are such.
void LeaveOutHidden(vtkImageData* image, vtkDataArray* own, TrainingInput& input)
{
  const vtkUnsignedCharArray* ghosts = image->GetPointGhostArray();
  vtkIdType point = 0;
  const vtkIdType points = ghosts ? ghosts->GetNumberOfTuples() : 0;
  while (point < points && !IsHidden(*ghosts, point)) {
    ++point;
  }
  if (point == points) {
    return;
  }
  const int type = input.values->GetDataType();
  if (type != VTK_FLOAT && type != VTK_DOUBLE) {
    input.showsHidden = true;
    return;
  }
  if (input.values == own) {
    input.values.TakeReference(vtkDataArray::CreateDataArray(type));
    input.values->DeepCopy(own);
  }
  for (; point < points; ++point) {
    if (IsHidden(*ghosts, point)) {
      input.values->SetTuple1(point, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

/// All point arrays but masks.
std::vector<vtkAbstractArray*> VolumesAmong(vtkDataSetAttributes& data)
{
  std::vector<vtkAbstractArray*> volumes;
  for (int k = 0; k < data.GetNumberOfArrays(); ++k) {
    vtkAbstractArray* array = data.GetAbstractArray(k);
    if (!IsMask(array->GetName())) {
      volumes.push_back(array);
    }
  }
  return volumes;
}

} // namespace

bool IsMask(const char* name)
{
  return name && (name == std::string_view(vtkDataSetAttributes::GhostArrayName()) ||
                  name == std::string_view("vtkValidPointMask")); // by vtkProbeFilter
}

TrainingInput MakeTrainingInput(vtkImageData* image, vtkAbstractArray* values)
{
  const bool isNamed = values->GetName() && *values->GetName();
  const std::string name = isNamed ? values->GetName() : inr::VolumeInfo().arrayName;
  auto* array = vtkDataArray::SafeDownCast(values);
  Require(array != nullptr,
          "array '" + name + "' is a " + values->GetClassName() + ", which does not hold numbers");
  int dims[3];
  image->GetDimensions(dims);
  TrainingInput input;
  input.info.dims = glm::i64vec3(dims[0], dims[1], dims[2]);
  const vtkIdType points = image->GetNumberOfPoints();
  Require(points > 0, "the image has no points");
  Require(array->GetNumberOfComponents() == 1,
          "array '" + name + "' has " + std::to_string(array->GetNumberOfComponents()) +
              " components; take one of them, or the magnitude, with a Calculator first");
  Require(array->GetNumberOfTuples() == points,
          "array '" + name + "' has " + std::to_string(array->GetNumberOfTuples()) +
              " values for " + std::to_string(points) + " points");
  const std::optional<inr::ScalarType> type = ScalarTypeOf(array->GetDataType());
  Require(type.has_value(),
          "array '" + name + "' holds " + array->GetDataTypeAsString() + ", not numbers");

  int extent[6];
  image->GetExtent(extent);
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], &input.info.origin.x);
  image->GetSpacing(&input.info.spacing.x);
  for (int axis = 0; axis < 3; ++axis) {
    const double spacing = input.info.spacing[axis];
    Require(std::isfinite(spacing) && spacing != 0.0,
            "the image's spacing is " + inr::NumberText(spacing) + " along an axis");
  }
  input.info.direction = glm::transpose(glm::make_mat3(image->GetDirectionMatrix()->GetData()));
  input.info.arrayName = name;
  vtkInformation* about = image->GetInformation();
  if (about->Has(vtkDataObject::DATA_TIME_STEP())) {
    const double time = about->Get(vtkDataObject::DATA_TIME_STEP());
    input.info.time = std::isfinite(time) ? std::optional<double>(time) : std::nullopt;
  }
  input.info.type = *type;
  input.values = Contiguous(array);
  LeaveOutHidden(image, array, input);
  input.data.values = input.values->GetVoidPointer(0);
  input.data.type = *type;
  input.data.dims = input.info.dims;
  return input;
}

vtkAbstractArray* DefaultArray(vtkDataSetAttributes& data)
{
  const std::vector<vtkAbstractArray*> arrays = VolumesAmong(data);
  vtkAbstractArray* active = data.GetScalars();
  if (active && !IsMask(active->GetName())) {
    return active;
  }
  return arrays.size() == 1 ? arrays.front() : nullptr;
}

std::string NoSuchArray(vtkImageData& image, const char* chosen)
{
  vtkDataSetAttributes& data = *image.GetPointData();
  std::string text = chosen && *chosen
                         ? "the image has no point array '" + std::string(chosen) + "'"
                         : std::string("no point array is chosen");
  const std::vector<vtkAbstractArray*> arrays = VolumesAmong(data);
  if (arrays.empty()) {
    const bool hasMasks = data.GetNumberOfArrays() > 0;
    text += std::string(", and the image has none") +
            (hasMasks ? " but vtkGhostType or vtkValidPointMask" : "");
    const bool hasCells = !VolumesAmong(*image.GetCellData()).empty();
    return text + (hasCells ? "; of its cell data CellDataToPointData makes some" : "");
  }
  text += "; Scalars takes one of";
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    const char* name = arrays[k]->GetName();
    text += std::string(k > 0 ? ", '" : " '") + (name ? name : "") + "'";
  }
  return text;
}
