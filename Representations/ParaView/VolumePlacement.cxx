// SPDX-License-Identifier: BSD-3-Clause
#include "VolumePlacement.h"

#include "Representations/Mapper/Scene/PlacedBox.h"
#include "SharedDrawing.h"
#include "vtkBoundingBox.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// Of an axis of a volume that is not turned.
struct Way
{
  int axis;    ///< of the world
  bool isDown; ///< along it
};

Way WayOf(int axis, vtkImageData& image, vtkMatrix4x4& matrix)
{
  double way[4] = {};
  DirectionInWorld(axis, image, matrix, way);
  int longest = 0;
  for (int row = 1; row < 3; ++row) {
    longest = std::abs(way[row]) > std::abs(way[longest]) ? row : longest;
  }
  return way[longest] == 0 ? Way{axis, false} : Way{longest, way[longest] < 0}; // or flat
}

} // namespace

bool VolumePlacement::update(vtkINRVolumeMapper& mapper, const double piece[6],
                             vtkMatrix4x4& matrix)
{
  const double* elements = matrix.GetData();
  const bool moved = !std::equal(elements, elements + 16, this->Matrix);
  std::copy_n(elements, 16, this->Matrix);
  double whole[6];
  std::copy_n(piece, 6, whole);
  mapper.GetWholeBounds(whole);
  PlacedBox(whole, matrix).GetBounds(whole);
  double part[6];
  mapper.GetPartOfWhole(part);
  auto* image = vtkImageData::SafeDownCast(mapper.GetDataSetInput());
  const bool isTurned = IsTurned(image, &matrix);
  std::copy_n(whole, 6, this->Bounds);
  for (int axis = 0; axis < 3; ++axis) {
    const Way way = isTurned || !image ? Way{axis, false} : WayOf(axis, *image, matrix);
    const double low = whole[2 * way.axis];
    const double high = whole[2 * way.axis + 1];
    for (int end = 0; end < 2; ++end) {
      const double at = way.isDown ? 1 - part[2 * axis + end] : part[2 * axis + end];
      const int which = way.isDown ? 1 - end : end;
      this->Bounds[2 * way.axis + which] = (1 - at) * low + at * high;
    }
  }
  return moved;
}

} // namespace inr
