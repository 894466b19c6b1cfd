// SPDX-License-Identifier: BSD-3-Clause
// Where the volume is, the whole of it and this process' piece.
#include "Representations/Mapper/Scene/MapperInput.h"
#include "vtkINRVolumeMapper.h"

#include <vtkImageData.h>
#include <vtkMatrix3x3.h>

#include <array>
#include <cmath>

double* vtkINRVolumeMapper::GetBounds()
{
  double* bounds = this->Superclass::GetBounds();
  if (this->GetDrawsTogether()) {
    this->GetWholeBounds(bounds);
  }
  const inr::MapperInput input = inr::FindInput(this);
  for (int axis = 0; input.array && axis < 3; ++axis) {
    if (input.grid.presented[axis] > 1) {
      continue;
    }
    const double half = input.grid.image->GetSpacing()[axis] / 2;
    for (int row = 0; row < 3; ++row) {
      const double pad =
          std::abs(input.grid.image->GetDirectionMatrix()->GetElement(row, axis) * half);
      bounds[2 * row] -= pad;
      bounds[2 * row + 1] += pad;
    }
  }
  return bounds;
}

void vtkINRVolumeMapper::GetWholeBounds(double bounds[6])
{
  const inr::MapperInput input = inr::FindInput(this);
  if (input.array) {
    inr::WholeBounds(input.grid, bounds);
  }
}

void vtkINRVolumeMapper::GetPieceBounds(double bounds[6])
{
  const inr::MapperInput input = inr::FindInput(this);
  if (input.array) {
    inr::BoundsOf(input.grid, inr::OwnExtent(input.grid), bounds);
  }
}

void vtkINRVolumeMapper::GetPartOfWhole(double part[6])
{
  const inr::MapperInput input = inr::FindInput(this);
  const std::array<int, 6> own = input.array ? inr::OwnExtent(input.grid) : std::array<int, 6>{};
  for (int axis = 0; axis < 3; ++axis) {
    const int last = input.array ? input.grid.presented[axis] - 1 : 0;
    for (int end = 0; end < 2; ++end) {
      part[2 * axis + end] = last > 0 ? static_cast<double>(own[2 * axis + end]) / last : end;
    }
  }
}

bool vtkINRVolumeMapper::GetHasPiece()
{
  const inr::MapperInput input = inr::FindInput(this);
  return input.array && inr::IsPiece(input.grid);
}
