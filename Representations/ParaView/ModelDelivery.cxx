// SPDX-License-Identifier: BSD-3-Clause
#include "ModelDelivery.h"

#include "Core/Model/ModelBytes.h"
#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkINRDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace inr {
namespace {

/// Where an image presents a model, which filters may have moved: origin, what is between the first
/// and the last point along each axis (of one point, its spacing), and the direction matrix by
/// rows.
std::array<double, 15> PlacementOf(vtkImageData* image, const vtkINRDataArray& array)
{
  std::array<double, 15> placement{};
  int first[3];
  array.GetShift(image, first);
  image->TransformIndexToPhysicalPoint(first, placement.data());
  int presented[3];
  array.GetPresentedDimensions(presented);
  for (int axis = 0; axis < 3; ++axis) {
    placement[3 + axis] = image->GetSpacing()[axis] * std::max(presented[axis] - 1, 1);
  }
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, placement.begin() + 6);
  return placement;
}

vtkSmartPointer<vtkImageData> ImageOf(const ModelPointer& model, const char* name,
                                      const double placement[15])
{
  int dims[3];
  int extent[6] = {};
  for (int axis = 0; axis < 3; ++axis) {
    dims[axis] = model->volume.dims[axis] > 1 ? 2 : 1;
    extent[2 * axis + 1] = dims[axis] - 1;
  }
  const auto array = vtkINRDataArray::Create(model, dims, extent);
  array->SetName(name);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(extent);
  image->SetOrigin(placement);
  image->SetSpacing(placement + 3);
  image->SetDirectionMatrix(placement + 6);
  image->GetPointData()->SetScalars(array);
  return image;
}

/// What an array's placement is called; longer than the array's own name, so another one.
std::string PlacementName(const std::string& array) { return "placement of " + array; }

/// The one that send() has put there, whatever ParaView has added; null for none.
vtkDoubleArray* FindPlacement(vtkPointData* points)
{
  for (int k = 0; points && k < points->GetNumberOfArrays(); ++k) {
    auto* array = vtkDoubleArray::SafeDownCast(points->GetAbstractArray(k));
    const std::string name = array && array->GetName() ? array->GetName() : "";
    if (name.rfind(PlacementName(""), 0) == 0 && array->GetNumberOfValues() == 15) {
      return array;
    }
  }
  return nullptr;
}

/// A tuple belongs to a point, and without a cell that is left out.
void AddPoint(vtkPolyData* carrier)
{
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell({0});
  carrier->SetPoints(points);
  carrier->SetVerts(vertices);
}

} // namespace

void ModelDelivery::send(vtkImageData* image, vtkPolyData* carrier)
{
  vtkAbstractArray* array = image ? vtkINRDataArray::FindIn(image->GetPointData()) : nullptr;
  const vtkINRDataArray* handle = vtkINRDataArray::SafeDownCast(array);
  if (!array || !handle || !handle->GetModel()) {
    return;
  }
  if (handle->GetModel() != this->Packed) {
    const std::string bytes = ModelToBytes(*handle->GetModel());
    this->Bytes = vtkSmartPointer<vtkUnsignedCharArray>::New();
    this->Bytes->SetNumberOfComponents(static_cast<int>(bytes.size()));
    this->Bytes->SetNumberOfTuples(1);
    std::copy(bytes.begin(), bytes.end(), this->Bytes->GetPointer(0));
    this->Packed = handle->GetModel();
  }
  const std::string name = array->GetName() ? array->GetName() : "";
  this->Bytes->SetName(name.c_str());
  const std::array<double, 15> places = PlacementOf(image, *handle);
  vtkNew<vtkDoubleArray> placement;
  placement->SetName(PlacementName(name).c_str());
  placement->SetNumberOfComponents(15);
  placement->InsertNextTuple(places.data());
  AddPoint(carrier);
  carrier->GetPointData()->AddArray(this->Bytes);
  carrier->GetPointData()->AddArray(placement);
}

vtkImageData* ModelDelivery::receive(vtkPolyData* carrier)
{
  vtkPointData* const points = carrier ? carrier->GetPointData() : nullptr;
  vtkDoubleArray* const placement = FindPlacement(points);
  auto* bytes = placement ? vtkUnsignedCharArray::SafeDownCast(
                                points->GetArray(placement->GetName() + PlacementName("").size()))
                          : nullptr;
  if (bytes != this->Bytes || placement != this->Placement) {
    this->Bytes = bytes;
    this->Placement = placement;
    this->Image = nullptr;
    if (bytes) {
      const unsigned char* first = bytes->GetPointer(0);
      this->Image = ImageOf(ModelFromBytes({first, first + bytes->GetNumberOfValues()}),
                            bytes->GetName(), placement->GetPointer(0));
    }
  }
  return this->Image;
}

} // namespace inr
