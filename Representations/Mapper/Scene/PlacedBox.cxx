// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/PlacedBox.h"

#include <vtkBoundingBox.h>
#include <vtkMatrix4x4.h>

namespace inr {

vtkBoundingBox PlacedBox(const double bounds[6], vtkMatrix4x4& matrix)
{
  const vtkBoundingBox box(bounds);
  vtkBoundingBox placed;
  for (int corner = 0; box.IsValid() && corner < 8; ++corner) {
    double at[4] = {0, 0, 0, 1};
    box.GetCorner(corner, at);
    matrix.MultiplyPoint(at, at);
    placed.AddPoint(at);
  }
  return placed;
}

} // namespace inr
