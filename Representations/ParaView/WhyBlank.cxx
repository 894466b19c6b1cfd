// SPDX-License-Identifier: BSD-3-Clause
#include "WhyBlank.h"

#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkProp3D.h>
#include <vtkVolumeMapper.h>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// A prop whose place is not a number is left out by the renderer, without a word.
bool IsPlaced(vtkProp3D* prop)
{
  const double* elements = prop->GetMatrix()->GetData();
  return std::all_of(elements, elements + 16, [](double x) { return std::isfinite(x); });
}

} // namespace

std::string WhyBlank(vtkProp3D* volume, vtkVolumeMapper* mapper)
{
  if (!IsPlaced(volume)) {
    return "The volume has no place: its position, scale, orientation or origin is not a finite "
           "number; set them anew";
  }
  vtkDataSet* data = mapper->GetDataSetInput();
  if (!data || data->GetNumberOfPoints() == 0) {
    return {}; // another process draws, or the reader has said why there is nothing
  }
  vtkDataArray* scalars = data->GetPointData()->GetScalars();
  const std::string advice =
      std::string("; colour by its point array") +
      (scalars && scalars->GetName() ? " '" + std::string(scalars->GetName()) + "'" : "");
  const char* name = mapper->GetArrayName();
  if (!name || !*name) {
    return "A volume of a solid colour cannot be drawn" + advice;
  }
  const bool isPointArray = mapper->GetScalarMode() == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA &&
                            data->GetPointData()->HasArray(name);
  return isPointArray ? "" : "The volume has no point array '" + std::string(name) + "'" + advice;
}

} // namespace inr
