// SPDX-License-Identifier: BSD-3-Clause
//
// Central differences of the trilinear interpolation, one voxel to either side, within a brick.
// What the six samples of one share is loaded once. Only for sources that are built once per
// instruction set; see Core/Inference/Lanes.h.
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/SampleLayout.h"
#include "Core/Render/Bricks/StoredVoxels.h"

namespace inr {
namespace INR_ISA {

namespace {

/// Samples, one after another: those of a batch that are chosen.
struct ChosenSamples
{
  Located located;
  std::int32_t path[SampleBatch::Room];
};

/// A bit for each axis along which a sample's neighbours are in its brick.
Ints AxesInside(const Way& way, const Floats (&places)[3])
{
  Ints inside{};
  for (int axis = 0; axis < 3; ++axis) {
    const Ints is = (places[axis] >= 1.0f) & (places[axis] < way.last[axis] - 1.0f);
    inside |= is & (Ints{} + (1 << axis));
  }
  return inside;
}

void Choose(const SampleBatch& batch, const int* which, int count, ChosenSamples& out,
            std::int32_t* inside)
{
  alignas(CacheLineBytes) float along[SampleBatch::Room];
  for (int k = 0; k < count; ++k) {
    out.path[k] = batch.path[which[k]];
    along[k] = batch.along[which[k]];
  }
  int end = 0;
  for (int first = 0; first < count; first = end) {
    end = first + 1;
    while (end < count && out.path[end] == out.path[first]) {
      ++end;
    }
    const Way way = SpreadWay(batch.paths[out.path[first]]);
    for (int k = first; k < end; k += LaneCount) { // what is behind the end is overwritten
      Floats places[3];
      FindPlaces(way, Load(along + k), places);
      for (int axis = 0; axis < 3; ++axis) {
        Store(out.located.place[axis] + k, places[axis]);
      }
      Store(out.located.quantum + k, way.quantum);
      StoreInts(inside + k, AxesInside(way, places));
    }
  }
  for (int lane = count; lane % LaneCount != 0; ++lane) { // whatever can be read
    out.path[lane] = out.path[count - 1];
    out.located.place[0][lane] = out.located.place[1][lane] = out.located.place[2][lane] = 0.0f;
  }
}

/// Where rows of voxels around a sample's cell begin, in the brick: at its edge, or beside it along
/// an axis. Where there is nothing beside it, it is the edge once more.
struct RowOffsets
{
  std::int32_t before[3][LaneCount];
  std::int32_t behind[3][LaneCount];
};

/// Pairs of voxels along x around a sample's cell.
template <typename Voxels> struct Neighbours
{
  Voxels before[4]; ///< x - 1 and x, at (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1)
  Voxels behind[4]; ///< x + 1 and x + 2, there
  /// x and x + 1: along y, at (y - 1, z), (y + 2, z), and the same at z + 1; along z, at
  /// (y, z - 1), (y, z + 2), and the same at y + 1.
  Voxels outer[2][4];
};

template <typename Voxels>
void LoadNeighbours(const BrickFormat& format, const SampleBatch& batch, const std::int32_t* path,
                    const RowOffsets& at, Neighbours<Voxels>& out)
{
  const std::int64_t dy = format.strideY;
  const std::int64_t dz = format.strideZ;
  const std::int64_t edges[4] = {0, dy, dz, dz + dy};
  for (int lane = 0; lane < LaneCount; ++lane) {
    const void* brick = batch.paths[path[lane]].voxels;
    const auto* voxels = static_cast<const typename Voxels::Stored*>(brick);
    for (int edge = 0; edge < 4; ++edge) {
      out.before[edge].load(lane, voxels + at.before[0][lane] + edges[edge]);
      out.behind[edge].load(lane, voxels + at.behind[0][lane] + edges[edge]);
    }
    for (int axis = 1; axis < 3; ++axis) {
      const std::int64_t other = axis == 1 ? dz : dy;
      const auto* before = voxels + at.before[axis][lane];
      const auto* behind = voxels + at.behind[axis][lane];
      out.outer[axis - 1][0].load(lane, before);
      out.outer[axis - 1][1].load(lane, behind);
      out.outer[axis - 1][2].load(lane, before + other);
      out.outer[axis - 1][3].load(lane, behind + other);
    }
  }
}

template <typename Voxels>
void DifferentiateAs(const BrickFormat& format, const SampleBatch& batch,
                     const ChosenSamples& chosen, int k, GradientBatch& gradients)
{
  AxisLocation at[3];
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = Locate(chosen.located.place[axis] + k, format.lastCell[axis]);
  }
  const int strides[3] = {1, format.strideY, format.strideZ};
  const Ints cell = at[0].cell + at[1].cell * strides[1] + at[2].cell * strides[2];
  RowOffsets offsets;
  Ints isFirst[3];
  Ints isLast[3];
  for (int axis = 0; axis < 3; ++axis) {
    isFirst[axis] = at[axis].cell < Ints{} + 1;
    isLast[axis] = at[axis].cell >= Ints{} + format.lastCell[axis];
    const Ints stride = Ints{} + strides[axis];
    // Pairs along x begin at x - 1 and x + 1; along the others, rows are y - 1 and y + 2.
    StoreInts(offsets.before[axis], cell - (isFirst[axis] ? Ints{} : stride));
    const Ints next = axis == 0 ? cell : cell + stride;
    StoreInts(offsets.behind[axis], next + (isLast[axis] ? Ints{} : stride));
  }
  Neighbours<Voxels> voxels;
  LoadNeighbours(format, batch, chosen.path + k, offsets, voxels);
  Floats edges[4];  // the field on the cell's edges along x
  Floats across[4]; // how it differs along x there
  for (int edge = 0; edge < 4; ++edge) {
    const FloatPair before = voxels.before[edge].pair();
    const FloatPair behind = voxels.behind[edge].pair();
    edges[edge] = Mix(isFirst[0] ? before.first : before.second,
                      isLast[0] ? behind.second : behind.first, at[0].weight);
    across[edge] = Mix(behind.first - before.first, behind.second - before.second, at[0].weight);
  }
  Floats beside[2][4];
  for (int row = 0; row < 4; ++row) {
    beside[0][row] = voxels.outer[0][row].pair().mix(at[0].weight);
    beside[1][row] = voxels.outer[1][row].pair().mix(at[0].weight);
  }
  const Floats half = Load(chosen.located.quantum + k) * 0.5f;
  const auto put = [&](int axis, Floats first, Floats second, Floats weight) {
    Store(gradients.along[axis] + k, Mix(first, second, weight) * half);
  };
  const Floats y = at[1].weight;
  const Floats z = at[2].weight;
  put(0, Mix(across[0], across[1], y), Mix(across[2], across[3], y), z);
  put(1, Mix(edges[1] - beside[0][0], beside[0][1] - edges[0], y),
      Mix(edges[3] - beside[0][2], beside[0][3] - edges[2], y), z);
  put(2, Mix(edges[2] - beside[1][0], beside[1][1] - edges[0], z),
      Mix(edges[3] - beside[1][2], beside[1][3] - edges[1], z), y);
}

void Differentiate(const BrickFormat& format, const SampleBatch& batch, const int* which, int count,
                   GradientBatch& gradients)
{
  ChosenSamples chosen;
  Choose(batch, which, count, chosen, gradients.inside);
  for (int k = 0; k < count; k += LaneCount) {
    switch (format.bytes) {
    case VoxelBytes::Four:
      DifferentiateAs<FloatVoxels>(format, batch, chosen, k, gradients);
      break;
    case VoxelBytes::Two:
      DifferentiateAs<ShortVoxels>(format, batch, chosen, k, gradients);
      break;
    case VoxelBytes::One:
      DifferentiateAs<ByteVoxels>(format, batch, chosen, k, gradients);
      break;
    }
  }
}

} // namespace

} // namespace INR_ISA
} // namespace inr
