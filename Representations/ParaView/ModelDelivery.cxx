// SPDX-License-Identifier: BSD-3-Clause
#include "ModelDelivery.h"

#include "Core/Model/ModelBytes.h"
#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkCompositeDataSet.h"
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

/// Where an image has a grid of so many points from point `first` on: origin, what is between the
/// first and the last point along each axis (of one point, its spacing), and the direction matrix
/// by rows.
std::array<double, 15> PlacementOf(vtkImageData* image, const int first[3], const int points[3])
{
  std::array<double, 15> placement{};
  image->TransformIndexToPhysicalPoint(first, placement.data());
  for (int axis = 0; axis < 3; ++axis) {
    placement[3 + axis] = image->GetSpacing()[axis] * std::max(points[axis] - 1, 1);
  }
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, placement.begin() + 6);
  return placement;
}

/// The same of the grid that presents a model, which filters may have moved.
std::array<double, 15> PlacementOf(vtkImageData* image, const vtkINRDataArray& array)
{
  int first[3];
  array.GetShift(image, first);
  int presented[3];
  array.GetPresentedDimensions(presented);
  return PlacementOf(image, first, presented);
}

/// The same of an image without a model.
std::array<double, 15> PlacementOf(vtkImageData* image)
{
  const int* extent = image->GetExtent();
  const int first[3] = {extent[0], extent[2], extent[4]};
  return PlacementOf(image, first, image->GetDimensions());
}

vtkSmartPointer<vtkImageData> ImageOf(const int dims[3], const double placement[15])
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(dims);
  image->SetOrigin(placement);
  image->SetSpacing(placement + 3);
  image->SetDirectionMatrix(placement + 6);
  return image;
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
  auto image = ImageOf(dims, placement);
  image->GetPointData()->SetScalars(array);
  return image;
}

/// Of arrays that are no INR, and that nobody draws, only the names.
vtkSmartPointer<vtkUnsignedCharArray> NamedArray(const char* name, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetName(name ? name : "");
  array->SetNumberOfTuples(tuples);
  array->Fill(0);
  return array;
}

/// What a carrier has of an image without a model, which has an array for each of that one's.
vtkSmartPointer<vtkImageData> ImageWithoutModel(vtkPointData* points, const double placement[15])
{
  const int dims[3] = {2, 2, 2};
  auto image = ImageOf(dims, placement);
  for (int k = 0; k < points->GetNumberOfArrays(); ++k) {
    if (vtkUnsignedCharArray::SafeDownCast(points->GetAbstractArray(k))) {
      image->GetPointData()->AddArray(NamedArray(points->GetArrayName(k), 8));
    }
  }
  return image;
}

/// What an array's placement is called; longer than the array's own name, so another one.
std::string PlacementName(const std::string& array) { return "placement of " + array; }

/// The same of what has none, an image's.
constexpr const char* WithoutModel = "without a model";

/// The one that send() has put there, whatever ParaView has added; null for none.
vtkDoubleArray* FindPlacement(vtkPointData* points)
{
  for (int k = 0; points && k < points->GetNumberOfArrays(); ++k) {
    auto* array = vtkDoubleArray::SafeDownCast(points->GetAbstractArray(k));
    const std::string name = array && array->GetName() ? array->GetName() : "";
    const bool isPlacement = name.rfind(PlacementName(""), 0) == 0 || name == WithoutModel;
    if (isPlacement && array->GetNumberOfValues() == 15) {
      return array;
    }
  }
  return nullptr;
}

constexpr const char* GroupMark = "a group";

void AddPlacement(vtkPolyData* carrier, const std::string& name,
                  const std::array<double, 15>& places)
{
  vtkNew<vtkDoubleArray> placement;
  placement->SetName(name.c_str());
  placement->SetNumberOfComponents(15);
  placement->InsertNextTuple(places.data());
  carrier->GetPointData()->AddArray(placement);
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

void ModelDelivery::send(vtkDataObject* data, vtkPolyData* carrier)
{
  if (vtkCompositeDataSet::SafeDownCast(data)) {
    AddPoint(carrier);
    carrier->GetPointData()->AddArray(NamedArray(GroupMark, 1));
    return;
  }
  auto* image = vtkImageData::SafeDownCast(data);
  if (!image || image->GetNumberOfPoints() == 0) {
    return;
  }
  AddPoint(carrier);
  vtkAbstractArray* array = vtkINRDataArray::FindIn(image->GetPointData());
  const vtkINRDataArray* handle = vtkINRDataArray::SafeDownCast(array);
  if (!array || !handle || !handle->GetModel()) {
    for (int k = 0; k < image->GetPointData()->GetNumberOfArrays(); ++k) {
      carrier->GetPointData()->AddArray(NamedArray(image->GetPointData()->GetArrayName(k), 1));
    }
    AddPlacement(carrier, WithoutModel, PlacementOf(image));
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
  carrier->GetPointData()->AddArray(this->Bytes);
  AddPlacement(carrier, PlacementName(name), PlacementOf(image, *handle));
}

vtkImageData* ModelDelivery::receive(vtkPolyData* carrier)
{
  vtkPointData* const points = carrier ? carrier->GetPointData() : nullptr;
  this->OfGroup = points && points->HasArray(GroupMark) && points->GetNumberOfArrays() == 1;
  vtkDoubleArray* const placement = FindPlacement(points);
  const bool hasModel = placement && placement->GetName() != std::string(WithoutModel);
  auto* bytes = hasModel ? vtkUnsignedCharArray::SafeDownCast(
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
    } else if (placement && !hasModel) {
      this->Image = ImageWithoutModel(points, placement->GetPointer(0));
    }
  }
  return this->Image;
}

} // namespace inr
