// SPDX-License-Identifier: BSD-3-Clause
//
// Values between the voxels of a cached brick, one sample by one thread; as Core's kernels find
// them by the vector (Core/Render/Bricks/BrickKernel.cpp).
#pragma once

#include "CUDA/Cache/Kernels/CacheView.h"
#include "CUDA/Device/Kernels/Mix.h"
#include "CUDA/Render/Kernels/ReadOnly.h"
#include "Core/Render/Bricks/BrickPath.h"

#include <cmath>

namespace inr {
namespace cuda {

/// Where along an axis a sample is in its brick.
INR_HOST_DEVICE inline float PlaceOn(const BrickPath& path, int axis, float along)
{
  const float place = fmaf(along, path.direction[axis], path.origin[axis]);
  return fminf(fmaxf(place, 0.0f), path.last[axis]);
}

/// A place in a brick: the first corner of its cell, and where it is from there.
struct CellPlace
{
  std::int32_t first; ///< voxel; the largest brick has 2^30
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
  const auto row = static_cast<int>(cache.rowStride);
  const auto layer = static_cast<int>(cache.layerStride);
  return {cell[0] + row * cell[1] + layer * cell[2], weight[0], weight[1], weight[2]};
}

/// Of a cell on a path.
INR_HOST_DEVICE inline CellPlace FindCellOn(const CacheView& cache, const BrickPath& path,
                                            float along)
{
  const float place[3] = {PlaceOn(path, 0, along), PlaceOn(path, 1, along),
                          PlaceOn(path, 2, along)};
  return FindCell(cache, place);
}

/// A place among a brick's voxels.
struct StoredPlace
{
  const void* voxels;
  CellPlace at;
};

/// Between the voxels around some places: all of these are read before one is waited for.
template <class Voxel, int Count>
INR_HOST_DEVICE inline void InterpolateStored(const CacheView& cache,
                                              const StoredPlace (&places)[Count],
                                              float (&stored)[Count])
{
  constexpr int rows = 4;
  const std::int64_t offsets[rows] = {0, cache.rowStride, cache.layerStride,
                                      cache.layerStride + cache.rowStride};
  Voxel read[Count][rows][2];
  for (int k = 0; k < Count; ++k) {
    const Voxel* const near = static_cast<const Voxel*>(places[k].voxels) + places[k].at.first;
    for (int row = 0; row < rows; ++row) {
      read[k][row][0] = ReadOnly(near + offsets[row]);
      read[k][row][1] = ReadOnly(near + offsets[row] + 1);
    }
  }
  for (int k = 0; k < Count; ++k) {
    const CellPlace& at = places[k].at;
    const auto along = [&](int row) {
      return Mix(static_cast<float>(read[k][row][0]), static_cast<float>(read[k][row][1]), at.x);
    };
    stored[k] = Mix(Mix(along(0), along(1), at.y), Mix(along(2), along(3), at.y), at.z);
  }
}

/// Trilinear, of bricks' values as they are stored.
template <int Count>
INR_HOST_DEVICE inline void FindStored(const CacheView& cache, const StoredPlace (&places)[Count],
                                       float (&stored)[Count])
{
  switch (cache.precision) {
  case CachePrecision::Float32:
    InterpolateStored<float>(cache, places, stored);
    break;
  case CachePrecision::Bits16:
    InterpolateStored<std::uint16_t>(cache, places, stored);
    break;
  case CachePrecision::Bits8:
    InterpolateStored<std::uint8_t>(cache, places, stored);
    break;
  }
}

/// Trilinear, of a brick's values.
INR_HOST_DEVICE inline float Interpolated(const CacheView& cache, const BrickView& brick,
                                          const CellPlace& at)
{
  const StoredPlace place[1] = {{brick.voxels, at}};
  float stored[1] = {};
  FindStored(cache, place, stored);
  return fmaf(stored[0], brick.step, brick.low);
}

/// At a place on a path.
INR_HOST_DEVICE inline float ValueOn(const CacheView& cache, const BrickPath& path, float along)
{
  return Interpolated(cache, {path.voxels, path.base, path.quantum},
                      FindCellOn(cache, path, along));
}

} // namespace cuda
} // namespace inr
