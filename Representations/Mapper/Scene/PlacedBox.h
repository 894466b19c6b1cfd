// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkBoundingBox.h>
#include <vtkMatrix4x4.h>

namespace inr {

/// The box along the world's axes around one of a volume with that matrix; none around none.
inline vtkBoundingBox PlacedBox(const double bounds[6], vtkMatrix4x4& matrix)
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
