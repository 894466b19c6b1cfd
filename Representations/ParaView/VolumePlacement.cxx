// SPDX-License-Identifier: BSD-3-Clause
#include "VolumePlacement.h"

#include "SharedDrawing.h"
#include "vtkBoundingBox.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"

#include <algorithm>

namespace inr {

namespace {

/// The box in the world around one of the volume; none around none.
vtkBoundingBox Placed(const double bounds[6], vtkMatrix4x4& matrix)
{
  vtkBoundingBox box;
  for (int corner = 0; vtkBoundingBox(bounds).IsValid() && corner < 8; ++corner) {
    double at[4] = {bounds[corner & 1], bounds[2 + (corner >> 1 & 1)], bounds[4 + (corner >> 2)],
                    1};
    matrix.MultiplyPoint(at, at);
    box.AddPoint(at);
  }
  return box;
}

} // namespace

bool VolumePlacement::update(vtkINRVolumeMapper& mapper, const double piece[6],
                             vtkMatrix4x4& matrix)
{
  const double* elements = matrix.GetData();
  const bool moved = !std::equal(elements, elements + 16, this->Matrix);
  std::copy_n(elements, 16, this->Matrix);
  if (!IsTurned(vtkImageData::SafeDownCast(mapper.GetDataSetInput()), &matrix)) {
    Placed(piece, matrix).GetBounds(this->Bounds);
    return moved;
  }
  double whole[6];
  std::copy_n(piece, 6, whole);
  mapper.GetWholeBounds(whole);
  Placed(whole, matrix).GetBounds(whole);
  double part[6];
  mapper.GetPartOfWhole(part);
  for (int k = 0; k < 6; ++k) {
    const double low = whole[k / 2 * 2];
    const double high = whole[k / 2 * 2 + 1];
    this->Bounds[k] = (1 - part[k]) * low + part[k] * high;
  }
  return moved;
}

} // namespace inr
