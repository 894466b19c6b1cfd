// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRDataArray.h"

#include "Core/Error.h"
#include "vtkINRTypedArray.h"

#include <vtkImageData.h>
#include <vtkPointData.h>

#include <string>

namespace {

inr::GridBox PartOf(const int presentedDims[3], const int extent[6])
{
  inr::GridBox part;
  for (int axis = 0; axis < 3; ++axis) {
    const int first = extent[2 * axis];
    const int last = extent[2 * axis + 1];
    if (first < 0 || last < first || last >= presentedDims[axis]) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "extent " + std::to_string(first) + " to " + std::to_string(last) +
                           " is not within a grid of " + std::to_string(presentedDims[axis]) +
                           " points");
    }
    part.first[axis] = first;
    part.size[axis] = std::int64_t{last} - first + 1;
  }
  return part;
}

} // namespace

vtkINRDataArray* vtkINRDataArray::SafeDownCast(vtkAbstractArray* array)
{
  return dynamic_cast<vtkINRDataArray*>(array);
}

vtkAbstractArray* vtkINRDataArray::FindIn(vtkPointData* points)
{
  if (vtkINRDataArray::SafeDownCast(points->GetScalars())) {
    return points->GetScalars();
  }
  for (int k = 0; k < points->GetNumberOfArrays(); ++k) {
    if (vtkINRDataArray::SafeDownCast(points->GetAbstractArray(k))) {
      return points->GetAbstractArray(k);
    }
  }
  return nullptr;
}

void vtkINRDataArray::GetShift(vtkImageData* image, int shift[3]) const
{
  int held[6];
  this->GetPresentedExtent(held);
  const int* const extent = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis) {
    shift[axis] = extent[2 * axis] - held[2 * axis];
  }
}

vtkSmartPointer<vtkDataArray> vtkINRDataArray::Create(inr::ModelPointer model,
                                                      const int presentedDims[3],
                                                      const int extent[6],
                                                      std::shared_ptr<Keepsake> keepsake)
{
  if (!keepsake) {
    keepsake = std::make_shared<Keepsake>();
  }
  const inr::GridBox part = PartOf(presentedDims, extent);
  const auto decoder = std::make_shared<const GridDecoder>(
      std::move(model), glm::ivec3(presentedDims[0], presentedDims[1], presentedDims[2]));
  const inr::VolumeInfo& volume = decoder->GetModel()->volume;

  auto array = DispatchScalar(volume.type, [&](auto zero) {
    auto typed = vtkSmartPointer<vtkINRTypedArray<decltype(zero)>>::New();
    typed->Initialize(decoder, part, keepsake);
    return vtkSmartPointer<vtkDataArray>(typed);
  });
  array->SetName(volume.arrayName.c_str());
  return array;
}
