// SPDX-License-Identifier: BSD-3-Clause
//
// Values between the voxels of a cached brick, one sample by one thread; as Core's kernels find
// them by the vector (Core/Render/BrickKernel.cpp).
#pragma once

#include "CUDA/Cache/Kernels/CacheView.h"
#include "CUDA/Device/Kernels/Mix.h"
#include "Core/Render/BrickPath.h"

#include <cmath>

namespace inr {
namespace cuda {

/// Where along an axis a sample is in its brick.
INR_HOST_DEVICE inline float PlaceOn(const BrickPath& path, int axis, float along)
{
  const float place = fmaf(along, path.direction[axis], path.origin[axis]);
  const float above = place > 0.0f ? place : 0.0f;
  return above < path.last[axis] ? above : path.last[axis];
}

/// A place in a brick: the first corner of its cell, and where it is from there.
struct CellPlace
{
  std::int64_t first; ///< voxel
  float x, y, z;      ///< weights of the far neighbours
};

/// `place`: in voxels, not negative, within the brick; three floats or doubles.
template <class Place>
INR_HOST_DEVICE inline CellPlace FindCell(const CacheView& cache, const Place& place)
{
  const glm::ivec3& dims = cache.hierarchy.brickDims();
  int cell[3];
  float weight[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int floor = static_cast<int>(place[axis]);
    cell[axis] = floor < dims[axis] - 2 ? floor : dims[axis] - 2;
    weight[axis] = static_cast<float>(place[axis] - cell[axis]);
  }
  return {cell[0] + cache.rowStride * cell[1] + cache.layerStride * cell[2], weight[0], weight[1],
          weight[2]};
}

template <class Voxel>
INR_HOST_DEVICE inline float InterpolateStored(const CacheView& cache, const void* voxels,
                                               const CellPlace& at)
{
  const Voxel* const near = static_cast<const Voxel*>(voxels) + at.first;
  const auto row = [&](std::int64_t offset) {
    return Mix(static_cast<float>(near[offset]), static_cast<float>(near[offset + 1]), at.x);
  };
  const float front = Mix(row(0), row(cache.rowStride), at.y);
  const float back = Mix(row(cache.layerStride), row(cache.layerStride + cache.rowStride), at.y);
  return Mix(front, back, at.z);
}

/// Trilinear, of a brick's values.
INR_HOST_DEVICE inline float Interpolated(const CacheView& cache, const BrickView& brick,
                                          const CellPlace& at)
{
  float stored = 0.0f;
  switch (cache.precision) {
  case CachePrecision::Float32:
    stored = InterpolateStored<float>(cache, brick.voxels, at);
    break;
  case CachePrecision::Bits16:
    stored = InterpolateStored<std::uint16_t>(cache, brick.voxels, at);
    break;
  case CachePrecision::Bits8:
    stored = InterpolateStored<std::uint8_t>(cache, brick.voxels, at);
    break;
  }
  return fmaf(stored, brick.step, brick.low);
}

/// At a place on a path.
INR_HOST_DEVICE inline float ValueOn(const CacheView& cache, const BrickPath& path, float along)
{
  const float place[3] = {PlaceOn(path, 0, along), PlaceOn(path, 1, along),
                          PlaceOn(path, 2, along)};
  return Interpolated(cache, {path.voxels, path.base, path.quantum}, FindCell(cache, place));
}

} // namespace cuda
} // namespace inr
