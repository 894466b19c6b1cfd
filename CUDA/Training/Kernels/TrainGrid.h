// SPDX-License-Identifier: BSD-3-Clause
//
// A mini-batch to the grid's features, and its gradients back to the grid: a level of a sample by
// one thread.
//
// Any number of samples add to an entry, in any order, and the sum is to be the same. So sums are
// integers of 64 bits, in units of a power of two that is chosen for each mini-batch. With D the
// largest |d loss / d encoded feature| and n samples, a sum is at most n D in magnitude: the
// weights of a sample's corners are at most 1 in all. The unit is such that n D, rounded up to
// powers of two, is 2^62 units: no sum overflows, and a unit is at most 2^-60 n D, where a float's
// last digit of D is 2^-24 D. What is less than half of a unit is zero.
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "CUDA/Inference/Kernels/Encode.h"
#include "Core/Training/Descent/TrainKernel.h"

#include <cmath>
#include <cstdint>

namespace inr {
namespace cuda {

struct TrainEncode
{
  static constexpr int Threads = 128;

  GridView<float> grid;
  const float* positions; ///< x, y, z
  std::int64_t count;
  float* encoded; ///< row f of all features begins at f * count

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    WithFeatures(this->grid.features, [&](auto features) {
      constexpr int size = decltype(features)::value;
      block.threads([&](int thread) {
        const std::int64_t step = std::int64_t{block.count()} * Threads;
        const std::int64_t all = this->grid.levelCount * this->count;
        for (std::int64_t k = std::int64_t{block.index()} * Threads + thread; k < all; k += step) {
          this->encode<size>(static_cast<int>(k / this->count), k % this->count);
        }
      });
    });
  }

private:
  template <int Features> INR_HOST_DEVICE void encode(int level, std::int64_t sample) const
  {
    const float* const xyz = this->positions + 3 * sample;
    const Point point{ClampToUnit(xyz[0]), ClampToUnit(xyz[1]), ClampToUnit(xyz[2])};
    float sums[Features];
    InterpolateAt(this->grid, this->grid.levels[level], point, sums);
    INR_UNROLL
    for (int f = 0; f < Features; ++f) {
      this->encoded[(level * Features + f) * this->count + sample] = sums[f];
    }
  }
};

/// What sums of gradients are counted in.
struct GradientUnit
{
  double perUnit;   ///< units in 1; 0 where all gradients are zero
  double ofUnit;    ///< 1 in units, NaN where a gradient is no number
  bool isUndefined; ///< in which case nothing is added up: every sum that is touched is NaN

  INR_HOST_DEVICE GradientUnit(std::uint32_t largest, std::int64_t samples)
      : perUnit(0.0), ofUnit(0.0), isUndefined(largest >= 0x7f800000u)
  {
    if (this->isUndefined) {
      this->ofUnit = NAN;
    } else if (largest > 0) {
      int bits = 0; // of the number of samples
      while ((std::int64_t{1} << bits) < samples) {
        ++bits;
      }
      const int magnitude = static_cast<int>(largest >> 23) - 126; // D < 2^magnitude
      this->perUnit = ldexp(1.0, 62 - bits - magnitude);
      this->ofUnit = ldexp(1.0, bits + magnitude - 62);
    }
  }

  INR_HOST_DEVICE std::uint64_t toUnits(float weight, float gradient) const
  {
    if (this->isUndefined) {
      return 1;
    }
    const double product = static_cast<double>(weight) * static_cast<double>(gradient);
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(rint(product * this->perUnit)));
  }
  INR_HOST_DEVICE float toGradient(std::uint64_t units) const
  {
    const auto sum = static_cast<double>(static_cast<std::int64_t>(units));
    return static_cast<float>(sum * this->ofUnit);
  }
};

struct TrainScatter
{
  static constexpr int Threads = 128;

  GridView<float> grid; ///< whose table is of no matter
  const float* positions;
  std::int64_t count;
  const float* delta;           ///< d loss / d encoded feature, as features lie in TrainEncode
  const std::uint32_t* largest; ///< see TrainNetwork
  std::uint64_t* sums;          ///< of each parameter of the grid, in units
  std::uint8_t* touched;        ///< a line of GradientLine parameters each

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    WithFeatures(this->grid.features, [&](auto features) {
      constexpr int size = decltype(features)::value;
      block.threads([&](int thread) {
        const GradientUnit unit(*this->largest, this->count);
        const std::int64_t step = std::int64_t{block.count()} * Threads;
        const std::int64_t all = this->grid.levelCount * this->count;
        for (std::int64_t k = std::int64_t{block.index()} * Threads + thread; k < all; k += step) {
          this->scatter<size>(static_cast<int>(k / this->count), k % this->count, unit);
        }
      });
    });
  }

private:
  template <int Features>
  INR_HOST_DEVICE void scatter(int l, std::int64_t sample, const GradientUnit& unit) const
  {
    const LevelView& level = this->grid.levels[l];
    const float* const xyz = this->positions + 3 * sample;
    const AxisCell x = LocateOnAxis(level.scale, this->grid.interpolation, ClampToUnit(xyz[0]));
    const AxisCell y = LocateOnAxis(level.scale, this->grid.interpolation, ClampToUnit(xyz[1]));
    const AxisCell z = LocateOnAxis(level.scale, this->grid.interpolation, ClampToUnit(xyz[2]));
    const CellWeights weights{x.weight, y.weight, z.weight};
    float own[Features];
    INR_UNROLL
    for (int f = 0; f < Features; ++f) {
      own[f] = this->delta[(l * Features + f) * this->count + sample];
    }
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const std::uint32_t entry = EntryOf(level, x.cell + (corner & 1u),
                                          y.cell + (corner >> 1 & 1u), z.cell + (corner >> 2));
      const std::uint64_t at = level.offset + std::uint64_t{entry} * Features;
      const float weight = weights.ofCorner(static_cast<int>(corner));
      INR_UNROLL
      for (int f = 0; f < Features; ++f) {
        const std::uint64_t units = unit.toUnits(weight, own[f]);
        if (units != 0) {
          AtomicAdd(this->sums[at + f], units);
        }
      }
      this->touched[at / GradientLine] = 1; // whoever else does, writes the same
    }
  }
};

} // namespace cuda
} // namespace inr
