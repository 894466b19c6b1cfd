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

/// What an item's samples are encoded from.
template <class Numbers> struct ItemGrid
{
  const GridView<typename Numbers::Feature>& grid;
  const LevelCells* cells; ///< of each level, like the plans
  const LatticePlan* plans;
  const float* rows; ///< see FindRows
};

/// `Width` features of a level, from feature `f` on, at the samples of an item with the same x and
/// z, one y after another: neighbours share what is found along x and z.
template <class Numbers, int Features, int Width> class SampleColumn
{
public:
  INR_HOST_DEVICE SampleColumn(const ItemGrid<Numbers>& item, int l, int f, int x, int z)
      : Item(item), Level(l), First(f), X(x), Z(z), AxisX(item.cells[l].axes[0][x]),
        AxisZ(item.cells[l].axes[2][z])
  {}

  /// Those of `Count` samples from `y` on: found(k, features) for each.
  template <int Count, class Found> INR_HOST_DEVICE void find(int y, const Found& found) const
  {
    const AxisCell* const along = this->Item.cells[this->Level].axes[1] + y;
    std::uint32_t at = along[0].cell;
    Row lower = this->row(at);
    Row upper = this->row(at + 1);
    INR_UNROLL
    for (int k = 0; k < Count; ++k) {
      const AxisCell cell = along[k];
      if (cell.cell != at) {
        lower = cell.cell == at + 1 ? upper : this->row(cell.cell);
        upper = this->row(cell.cell + 1);
        at = cell.cell;
      }
      float features[Width];
      INR_UNROLL
      for (int f = 0; f < Width; ++f) {
        features[f] = Mix(lower.features[f], upper.features[f], cell.weight);
      }
      found(k, features);
    }
  }

private:
  using Feature = typename Numbers::Feature;

  /// At a lattice point's y.
  struct Row
  {
    float features[Width];
  };

  INR_HOST_DEVICE Row row(std::uint32_t y) const
  {
    const LatticePlan& plan = this->Item.plans[this->Level];
    return plan.first < 0 ? this->gathered(y) : this->kept(plan, y);
  }

  INR_HOST_DEVICE Row kept(const LatticePlan& plan, std::uint32_t y) const
  {
    const int layer = static_cast<int>(this->AxisZ.cell - plan.lower[1]);
    const int number = plan.first + layer * plan.down + static_cast<int>(y - plan.lower[0]);
    const auto* const front = this->Item.rows + RowPlace(number, this->X, Features) + this->First;
    const auto* const back = front + RowPlace(plan.down, 0, Features);
    return this->mixed(*reinterpret_cast<const Entry<float, Width>*>(front),
                       *reinterpret_cast<const Entry<float, Width>*>(back));
  }

  INR_HOST_DEVICE Row gathered(std::uint32_t y) const
  {
    Entry<Feature, Width> corners[4]; // all of them on their way before the first is used
    INR_UNROLL
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      corners[corner] =
          this->entry(this->AxisX.cell + (corner & 1u), y, this->AxisZ.cell + (corner >> 1));
    }
    Row row;
    INR_UNROLL
    for (int f = 0; f < Width; ++f) {
      row.features[f] =
          Mix(Mix(corners[0][f], corners[1][f], this->AxisX.weight),
              Mix(corners[2][f], corners[3][f], this->AxisX.weight), this->AxisZ.weight);
    }
    return row;
  }

  INR_HOST_DEVICE Entry<Feature, Width> entry(std::uint32_t x, std::uint32_t y,
                                              std::uint32_t z) const
  {
    const LevelView& level = this->Item.grid.levels[this->Level];
    const Feature* const table = this->Item.grid.table + level.offset + this->First;
    const std::uint64_t place = std::uint64_t{EntryOf(level, x, y, z)} * Features;
    return *reinterpret_cast<const Entry<Feature, Width>*>(table + place);
  }

  INR_HOST_DEVICE Row mixed(const Entry<float, Width>& front, const Entry<float, Width>& back) const
  {
    Row row;
    INR_UNROLL
    for (int f = 0; f < Width; ++f) {
      row.features[f] = Mix(front[f], back[f], this->AxisZ.weight);
    }
    return row;
  }

  const ItemGrid<Numbers>& Item;
  int Level;
  int First;
  int X;
  int Z;
  AxisCell AxisX;
  AxisCell AxisZ;
};

/// Inputs of the network, see FusedNetwork.h: 16 * Halves samples of an item, from (0, y, z) on.
template <class Numbers, int Halves, class Warp> class BrickInputs
{
public:
  INR_HOST_DEVICE BrickInputs(Warp& warp, const ItemGrid<Numbers>& item, int y, int z)
      : Self(warp), Item(item), Y(y), Z(z)
  {}

  template <class Function>
  INR_HOST_DEVICE void forEachTile(int tiles, const Function& function) const
  {
    for (int k = 0; k < tiles; ++k) {
      typename Warp::template PerLane<typename Numbers::Input> shares[Halves];
      this->Self.exchange([&](int lane) { // lanes part in there, and multiply together
        SumShare values[Halves];
        INR_UNROLL
        for (int half = 0; half < 2; ++half) { // of the tile's inputs
          const int column = k * TileSize + 8 * half + ColumnOf(lane);
          WithFeatures(this->Item.grid.features, [&](auto features) {
            this->encode<decltype(features)::value>(lane, column, 4 * half, values);
          });
        }
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
  /// Inputs number `column` and the next, to the values of each share from `first` on.
  template <int Features>
  INR_HOST_DEVICE void encode(int lane, int column, int first, SumShare (&values)[Halves]) const
  {
    constexpr int width = Features < 2 ? 1 : 2;
    INR_UNROLL
    for (int part = 0; part < 2; part += width) {
      const int l = (column + part) / Features;
      const int f = (column + part) % Features;
      const auto put = [&](int k, const auto& features) {
        INR_UNROLL
        for (int w = 0; w < width; ++w) {
          values[k / 2].values[first + 2 * (k % 2) + part + w] = features[w];
        }
      };
      if (l < this->Item.grid.levelCount) {
        const SampleColumn<Numbers, Features, width> samples(this->Item, l, f, RowOf(lane),
                                                             this->Z);
        samples.template find<2 * Halves>(this->Y, put);
      } else {
        const float zeros[width] = {};
        INR_UNROLL
        for (int k = 0; k < 2 * Halves; ++k) {
          put(k, zeros);
        }
      }
    }
  }

  Warp& Self;
  const ItemGrid<Numbers>& Item;
  int Y;
  int Z;
};

} // namespace cuda
} // namespace inr
