// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbouring samples share of the grid: a cube of samples lies in few cells of a coarse
// level. Each row of lattice points along x is interpolated once, at the samples' x, into shared
// memory; and from these rows, for some layers of samples at a time, those at the layers' z.
#pragma once

#include "CUDA/Inference/Kernels/BrickGeometry.h"
#include "CUDA/Inference/Kernels/Encode.h"
#include "CUDA/Inference/Kernels/FusedShared.h"

namespace inr {
namespace cuda {

/// Where an item's samples are in a level of the grid.
struct LevelPart
{
  AxisCell axes[3][ItemSize]; ///< cells of y and z are counted from the first sample's on
  std::uint32_t lower[2];     ///< those of the first sample
  std::int32_t down;          ///< lattice points between the first and the last sample, along y
  std::int32_t rows;          ///< of such points, along x; more than MostLatticeRows: very many
  std::int32_t first;         ///< of its rows among those that are kept; negative where its are not
  std::int32_t layerAt;       ///< the same of its rows of a layer of samples
};

/// Rows of a level that are kept at most: beyond, samples lie in cells of their own.
constexpr int MostLatticeRows = (ItemSize + 1) * (ItemSize + 1);

/// Goes through the levels, and tells of which rows are kept.
class KeptRows
{
public:
  INR_HOST_DEVICE explicit KeptRows(const RowRoom& room) : Room(room) {}

  /// To the next level; whether its rows are kept.
  INR_HOST_DEVICE bool enter(const LevelPart& part)
  {
    this->First = this->End;
    this->FirstOfLayer = this->EndOfLayer;
    const bool kept = part.rows <= MostLatticeRows && this->End + part.rows <= this->Room.rows &&
                      this->EndOfLayer + part.down <= this->Room.ofLayer;
    this->End += kept ? part.rows : 0;
    this->EndOfLayer += kept ? part.down : 0;
    return kept;
  }
  INR_HOST_DEVICE std::int32_t first() const { return this->First; }
  INR_HOST_DEVICE std::int32_t end() const { return this->End; }
  INR_HOST_DEVICE std::int32_t firstOfLayer() const { return this->FirstOfLayer; }

private:
  RowRoom Room;
  std::int32_t First = 0;
  std::int32_t End = 0;
  std::int32_t FirstOfLayer = 0;
  std::int32_t EndOfLayer = 0;
};

/// A sample's coordinates along an axis, and the level's cells there.
class SamplePlaces
{
public:
  /// `coordinates`: ItemSize of each axis.
  INR_HOST_DEVICE SamplePlaces(const float* coordinates, const LevelView& level,
                               GridInterpolation interpolation)
      : Coordinates(coordinates), Scale(level.scale), Interpolation(interpolation)
  {}

  INR_HOST_DEVICE AxisCell cell(int axis, int sample) const
  {
    return LocateOnAxis(this->Scale, this->Interpolation,
                        this->Coordinates[axis * ItemSize + sample]);
  }
  /// Lattice points between the first and the last sample.
  INR_HOST_DEVICE std::int64_t pointsAlong(int axis) const
  {
    return std::int64_t{this->cell(axis, ItemSize - 1).cell} -
           std::int64_t{this->cell(axis, 0).cell} + 2;
  }

private:
  const float* Coordinates;
  float Scale;
  GridInterpolation Interpolation;
};

/// Cell number k of the 3 * ItemSize of a level.
INR_HOST_DEVICE inline void SetCell(const SamplePlaces& places, int k, LevelPart& part)
{
  const int axis = k / ItemSize;
  AxisCell cell = places.cell(axis, k % ItemSize);
  if (axis > 0) {
    cell.cell -= places.cell(axis, 0).cell;
  }
  part.axes[axis][k % ItemSize] = cell;
}

/// All but the cells, and where rows are.
INR_HOST_DEVICE inline void SetExtent(const SamplePlaces& places, LevelPart& part)
{
  const std::int64_t down = places.pointsAlong(1);
  const std::int64_t deep = places.pointsAlong(2);
  const bool few = down <= MostLatticeRows && deep <= MostLatticeRows;
  part.lower[0] = places.cell(1, 0).cell;
  part.lower[1] = places.cell(2, 0).cell;
  part.down = few ? static_cast<std::int32_t>(down) : 0;
  part.rows = few ? static_cast<std::int32_t>(down * deep) : MostLatticeRows + 1;
}

/// Sets where rows of level l are, behind those of the levels before it.
INR_HOST_DEVICE inline void SetFirst(LevelPart* parts, int l, const RowRoom& room)
{
  KeptRows kept(room);
  for (int k = 0; k < l; ++k) {
    kept.enter(parts[k]);
  }
  parts[l].first = kept.enter(parts[l]) ? kept.first() : -1;
  parts[l].layerAt = kept.firstOfLayer();
}

/// Where a sample's features are, of row `row` of all.
INR_HOST_DEVICE inline int RowPlace(int row, int sample, int features)
{
  return (row * ItemSize + sample) * features;
}

/// A row at one sample's x.
template <int Features, class Number>
INR_HOST_DEVICE inline void FindRow(const GridView<Number>& grid, const LevelView& level,
                                    const LevelPart& part, int row, int sample, float* to)
{
  const auto* const table = TableOf<Number, Features>(grid, level);
  const std::uint32_t y = part.lower[0] + static_cast<std::uint32_t>(row % part.down);
  const std::uint32_t z = part.lower[1] + static_cast<std::uint32_t>(row / part.down);
  const AxisCell& x = part.axes[0][sample];
  const Entry<Number, Features> left = table[EntryOf(level, x.cell, y, z)];
  const Entry<Number, Features> right = table[EntryOf(level, x.cell + 1, y, z)];
  float features[Features];
  INR_UNROLL
  for (int f = 0; f < Features; ++f) {
    features[f] = Mix(left[f], right[f], x.weight);
  }
  Store(features, to);
}

/// A thread's share of all rows that are kept: an item's samples of each, features fastest.
template <int Features, class Number>
INR_HOST_DEVICE inline void FindRows(const GridView<Number>& grid, const LevelPart* parts,
                                     const RowRoom& room, float* rows, int thread, int threads)
{
  KeptRows kept(room);
  int next = 0; // level
  for (int k = thread;; k += threads) {
    const int row = k / ItemSize;
    while (row >= kept.end()) {
      if (next == grid.levelCount) {
        return;
      }
      kept.enter(parts[next++]);
    }
    FindRow<Features>(grid, grid.levels[next - 1], parts[next - 1], row - kept.first(),
                      k % ItemSize, rows + RowPlace(row, k % ItemSize, Features));
  }
}

/// A thread's share of the rows at the z of `layers` layers of samples, from layer `z` on: of each
/// level behind each other those of these layers, y fastest.
template <int Features>
INR_HOST_DEVICE inline void MixLayers(const LevelPart* parts, int levelCount, const float* rows,
                                      int z, int layers, float* mixed, int thread, int threads)
{
  constexpr int width = Features < 4 ? Features : 4;
  constexpr int parcels = ItemSize * Features / width; // of a row
  int level = 0;
  int before = 0; // parcels
  int of = 0;
  for (int k = thread;; k += threads) {
    while (k >= before + of) {
      before += of;
      of = 0;
      while (level < levelCount && parts[level].first < 0) {
        ++level;
      }
      if (level == levelCount) {
        return;
      }
      of = parts[level++].down * layers * parcels;
    }
    const LevelPart& part = parts[level - 1];
    const int within = k - before;
    const int row = within / parcels; // of the level's
    const int place = within % parcels * width;
    const AxisCell cell = part.axes[2][z + row / part.down];
    const int from = part.first + static_cast<int>(cell.cell) * part.down + row % part.down;
    const float* const front = rows + RowPlace(from, 0, Features) + place;
    const float* const back = front + RowPlace(part.down, 0, Features);
    const auto near = *reinterpret_cast<const Entry<float, width>*>(front);
    const auto far = *reinterpret_cast<const Entry<float, width>*>(back);
    float features[width];
    INR_UNROLL
    for (int f = 0; f < width; ++f) {
      features[f] = Mix(near[f], far[f], cell.weight);
    }
    Store(features, mixed + RowPlace(part.layerAt * layers + row, 0, Features) + place);
  }
}

} // namespace cuda
} // namespace inr
