// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Grid/PresentedGrid.h"

#include "Core/Error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace {

/// Points per axis when the spacing grows by 1/`scale`.
glm::i64vec3 ScaledDims(const glm::i64vec3& native, double scale)
{
  glm::i64vec3 dims{1};
  for (int axis = 0; axis < 3; ++axis) {
    const auto cells = static_cast<std::int64_t>(static_cast<double>(native[axis] - 1) * scale);
    dims[axis] = std::min(native[axis], std::max<std::int64_t>(2, cells + 1));
  }
  return dims;
}

/// In floating point: the product of three sizes may not fit any integer.
double CountPoints(const glm::i64vec3& dims)
{
  return static_cast<double>(dims.x) * static_cast<double>(dims.y) * static_cast<double>(dims.z);
}

} // namespace

glm::i64vec3 FinestDims(const glm::i64vec3& native, double maximumPoints)
{
  if (CountPoints(native) <= maximumPoints) {
    return native;
  }
  double coarse = 0;
  double fine = 1;
  for (int step = 0; step < 64; ++step) { // halves the interval down to the last bit
    const double middle = 0.5 * (coarse + fine);
    (CountPoints(ScaledDims(native, middle)) <= maximumPoints ? coarse : fine) = middle;
  }
  return ScaledDims(native, coarse);
}

PresentedGrid PresentGrid(const inr::VolumeInfo& volume, std::int64_t maximumPoints)
{
  if (maximumPoints < 0) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "MaximumGridPoints is " + std::to_string(maximumPoints) +
                         "; set a number of points, or 0 for the native grid");
  }
  const double native = CountPoints(volume.dims);
  const double wanted = maximumPoints > 0 ? static_cast<double>(maximumPoints) : native;
  const double limit = std::min(wanted, static_cast<double>(LargestPresentedGrid));
  const glm::i64vec3 dims = FinestDims(volume.dims, limit);

  PresentedGrid grid = PresentGridOf(volume, glm::ivec3(dims));
  grid.limited = std::min(wanted, native) > limit;
  return grid;
}

PresentedGrid PresentGridOf(const inr::VolumeInfo& volume, const glm::ivec3& dims)
{
  PresentedGrid grid;
  grid.dims = dims;
  grid.spacing = volume.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t native = volume.dims[axis];
    if ((native == 1) != (dims[axis] == 1)) {
      throw inr::Error(inr::ErrorCode::InvalidArgument,
                       "the volume has " + std::to_string(native) +
                           " voxels along an axis, and the other steps of the series have " +
                           std::to_string(dims[axis]) +
                           "; flat and thick volumes cannot be steps of one series");
    }
    if (dims[axis] != native) {
      grid.spacing[axis] *= static_cast<double>(native - 1) / static_cast<double>(dims[axis] - 1);
    }
  }
  return grid;
}
