// SPDX-License-Identifier: BSD-3-Clause
//
// An item's samples, encoded where the network wants them: in the lanes' registers. A tile's row r
// is the sample with x = r % 8 and y = r / 8, so that a lane's four numbers of a tile are two
// features of one level at two samples, one below the other.
#pragma once

#include "CUDA/Inference/Kernels/LatticeRows.h"
#include "CUDA/Inference/Kernels/Numbers.h"

namespace inr {
namespace cuda {

/// What some layers of an item's samples are encoded from.
template <class Numbers> struct LayerGrid
{
  const GridView<typename Numbers::Feature>& grid;
  const LevelPart* parts; ///< of each level
  const float* mixed;     ///< see MixLayers
  int first;              ///< of the layers
  int layers;
};

/// `Width` features of a level whose rows are kept, at samples of an item with the same x and z.
template <int Features, int Width> class SampleColumn
{
public:
  /// `rows`: at the samples' x and z, and from their first feature on.
  INR_HOST_DEVICE SampleColumn(const LevelPart& part, const float* rows)
      : Along(part.axes[1]), Rows(rows)
  {}

  /// Those of `Count` samples from `y` on.
  template <int Count> INR_HOST_DEVICE void find(int y, float (&features)[Count][Width]) const
  {
    INR_UNROLL
    for (int k = 0; k < Count; ++k) {
      const AxisCell cell = this->Along[y + k];
      const float* const row = this->Rows + RowPlace(static_cast<int>(cell.cell), 0, Features);
      const auto lower = *reinterpret_cast<const Entry<float, Width>*>(row);
      const auto upper =
          *reinterpret_cast<const Entry<float, Width>*>(row + RowPlace(1, 0, Features));
      INR_UNROLL
      for (int f = 0; f < Width; ++f) {
        features[k][f] = Mix(lower[f], upper[f], cell.weight);
      }
    }
  }

private:
  const AxisCell* Along; ///< y
  const float* Rows;
};

/// The same of a level of which no rows are kept, of `count` samples from `y` on, to found[0 ...].
template <class Numbers, int Features, int Width>
INR_HOST_DEVICE INR_CALLED void GatherColumn(LayerGrid<Numbers> item, int level, int first, int x,
                                             int y, int z, int count, float* found)
{
  using Feature = typename Numbers::Feature;
  const LevelView& view = item.grid.levels[level];
  const LevelPart& part = item.parts[level];
  const auto* const table = item.grid.table + view.offset + first;
  const AxisCell cellX = part.axes[0][x];
  const AxisCell cellZ = part.axes[2][z];
  for (int k = y; k < y + count; ++k) {
    const AxisCell cellY = part.axes[1][k];
    const auto entryOf = [&](int corner) {
      const auto bits = static_cast<std::uint32_t>(corner);
      const std::uint64_t entry =
          EntryOf(view, cellX.cell + (bits & 1u), part.lower[0] + cellY.cell + (bits >> 1 & 1u),
                  part.lower[1] + cellZ.cell + (bits >> 2));
      return *reinterpret_cast<const Entry<Feature, Width>*>(table + entry * Features);
    };
    float features[Width];
    Interpolate<Width, Feature>({cellX.weight, cellY.weight, cellZ.weight}, entryOf, features);
    for (int f = 0; f < Width; ++f) {
      *found++ = features[f];
    }
  }
}

/// Inputs of the network, see FusedNetwork.h: 16 * Halves samples of an item, from (0, y, z) on.
template <class Numbers, int Halves, class Warp> class BrickInputs
{
public:
  INR_HOST_DEVICE BrickInputs(Warp& warp, const LayerGrid<Numbers>& item, int y, int z)
      : Self(warp), Item(item), Y(y), Z(z)
  {}

  template <class Function>
  INR_HOST_DEVICE void forEachTile(int tiles, const Function& function) const
  {
    for (int k = 0; k < tiles; ++k) {
      typename Warp::template PerLane<typename Numbers::Input> shares[Halves];
      this->Self.exchange([&](int lane) { // lanes part in there, and multiply together
        SumShare values[Halves];
        WithFeatures(this->Item.grid.features, [&](auto features) {
          INR_UNROLL
          for (int half = 0; half < 2; ++half) { // of the tile's inputs
            this->encode<decltype(features)::value>(lane, k * TileSize + 8 * half + ColumnOf(lane),
                                                    4 * half, values);
          }
        });
        INR_UNROLL
        for (int h = 0; h < Halves; ++h) {
          shares[h][lane] = Numbers::inputOf(Numbers::keep(values[h]));
        }
      });
      function(
          k, [&](int h) -> const auto& { return shares[h]; });
    }
  }

private:
  static constexpr int Samples = 2 * Halves; ///< of a lane

  /// Inputs number `column` and the next, to the values of each share from `first` on.
  template <int Features>
  INR_HOST_DEVICE void encode(int lane, int column, int first, SumShare (&values)[Halves]) const
  {
    constexpr int width = Features < 2 ? 1 : 2;
    INR_UNROLL
    for (int part = 0; part < 2; part += width) {
      float features[Samples][width];
      this->find<Features>((column + part) / Features, (column + part) % Features, RowOf(lane),
                           features);
      INR_UNROLL
      for (int k = 0; k < Samples; ++k) {
        INR_UNROLL
        for (int w = 0; w < width; ++w) {
          values[k / 2].values[first + 2 * (k % 2) + part + w] = features[k][w];
        }
      }
    }
  }

  /// Zeros beyond the last level.
  template <int Features, int Width>
  INR_HOST_DEVICE void find(int level, int first, int x, float (&features)[Samples][Width]) const
  {
    const LevelPart* const part = this->Item.parts + level;
    if (level < this->Item.grid.levelCount && part->first >= 0) {
      const int layer =
          part->layerAt * this->Item.layers + (this->Z - this->Item.first) * part->down;
      SampleColumn<Features, Width>(*part, this->Item.mixed + RowPlace(layer, x, Features) + first)
          .find(this->Y, features);
      return;
    }
    float found[Samples * Width] = {}; // in memory, where `features` need not be
    if (level < this->Item.grid.levelCount) {
      GatherColumn<Numbers, Features, Width>(this->Item, level, first, x, this->Y, this->Z, Samples,
                                             found);
    }
    INR_UNROLL
    for (int k = 0; k < Samples * Width; ++k) {
      features[k / Width][k % Width] = found[k];
    }
  }

  Warp& Self;
  const LayerGrid<Numbers>& Item;
  int Y;
  int Z;
};

} // namespace cuda
} // namespace inr
