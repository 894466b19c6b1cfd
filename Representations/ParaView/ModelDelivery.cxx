// SPDX-License-Identifier: BSD-3-Clause
#include "ModelDelivery.h"

#include "Core/Model/ModelBytes.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkINRDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <utility>

namespace inr {
namespace {

vtkSmartPointer<vtkImageData> ImageOf(const ModelPointer& model, const char* name)
{
  const VolumeInfo& volume = model->volume;
  int dims[3];
  int extent[6] = {};
  double spacing[3];
  double direction[9];
  for (int axis = 0; axis < 3; ++axis) {
    dims[axis] = volume.dims[axis] > 1 ? 2 : 1;
    extent[2 * axis + 1] = dims[axis] - 1;
    spacing[axis] =
        volume.spacing[axis] * (dims[axis] > 1 ? static_cast<double>(volume.dims[axis] - 1) : 1.0);
    for (int column = 0; column < 3; ++column) {
      direction[3 * axis + column] = volume.direction[column][axis];
    }
  }
  const auto array = vtkINRDataArray::Create(model, dims, extent);
  array->SetName(name);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(extent);
  image->SetOrigin(volume.origin.x, volume.origin.y, volume.origin.z);
  image->SetSpacing(spacing);
  image->SetDirectionMatrix(direction);
  image->GetPointData()->SetScalars(array);
  return image;
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
  vtkDataArray* scalars = image ? image->GetPointData()->GetScalars() : nullptr;
  const vtkINRDataArray* handle = vtkINRDataArray::SafeDownCast(scalars);
  if (!scalars || !handle || !handle->GetModel()) {
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
  this->Bytes->SetName(scalars->GetName());
  AddPoint(carrier);
  carrier->GetPointData()->AddArray(this->Bytes);
}

vtkImageData* ModelDelivery::receive(vtkPolyData* carrier)
{
  auto* bytes =
      carrier ? vtkUnsignedCharArray::SafeDownCast(carrier->GetPointData()->GetArray(0)) : nullptr;
  if (bytes != this->Bytes) {
    this->Bytes = bytes;
    this->Image = nullptr;
    if (bytes) {
      const unsigned char* first = bytes->GetPointer(0);
      this->Image =
          ImageOf(ModelFromBytes({first, first + bytes->GetNumberOfValues()}), bytes->GetName());
    }
  }
  return this->Image;
}

} // namespace inr
