// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkBoundingBox;
class vtkMatrix4x4;

namespace inr {

/// The box along the world's axes around one of a volume with that matrix; none around none.
vtkBoundingBox PlacedBox(const double bounds[6], vtkMatrix4x4& matrix);

} // namespace inr
