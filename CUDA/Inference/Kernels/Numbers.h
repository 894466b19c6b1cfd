// SPDX-License-Identifier: BSD-3-Clause
//
// What the fused kernels compute with: features, weights, and a lane's share of a layer's inputs.
#pragma once

#include "CUDA/Device/Kernels/WideTiles.h"
#include "CUDA/Inference/Kernels/Activate.h"

namespace inr {
namespace cuda {

/// Numbers and what goes into a layer are halves; sums are float32.
struct HalfNumbers
{
  using Feature = HalfBits;
  using Staged = HalfBits; ///< an encoded sample's feature in shared memory
  using Weight = WeightShare;
  using Kept = InputShare; ///< a tile of a layer's results
  using Input = InputShare;
  static constexpr int WeightShares = 1; ///< of a tile, for each lane
  static constexpr bool HasSecondWeights = false;

  /// Tiles of samples that a warp takes through the network at once, of 16 * tiles neurons.
  INR_HOST_DEVICE static constexpr int halves(int tiles) { return tiles < 8 ? 2 : 1; }

  /// Features of a sample, as they come: in the order of SumShare.
  INR_HOST_DEVICE static Kept keep(const SumShare& values) { return activate(Unchanged(), values); }
  template <class Activate>
  INR_HOST_DEVICE static Kept activate(const Activate& activate, const SumShare& sums)
  {
    Kept kept;
    INR_UNROLL
    for (int r = 0; r < 4; ++r) {
      kept.pairs[r] = PackHalves(activate(sums.values[2 * r]), activate(sums.values[2 * r + 1]));
    }
    return kept;
  }
  INR_HOST_DEVICE static Kept activate(const Rectified& /*activate*/, const SumShare& sums)
  {
    Kept kept;
    INR_UNROLL
    for (int r = 0; r < 4; ++r) {
      kept.pairs[r] = PackRectified(sums.values[2 * r], sums.values[2 * r + 1]);
    }
    return kept;
  }
  INR_HOST_DEVICE static Kept load(const Staged* rows, int stride, int lane)
  {
    return LoadInputs(rows, stride, lane);
  }
  INR_HOST_DEVICE static const Input& inputOf(const Kept& kept) { return kept; }

  /// NaN where a number left the range of halves on its way.
  template <class Activate> INR_HOST_DEVICE static float output(const Activate& activate, float sum)
  {
    return activate(sum);
  }
};

/// Everything is float32, by products of parts of numbers; see WideTiles.h.
struct FloatNumbers
{
  using Feature = float;
  using Staged = float;
  using Weight = WideWeightShare;
  using Kept = SumShare;
  using Input = WideInputShare;
  static constexpr int WeightShares = 2;
  static constexpr bool HasSecondWeights = true;

  INR_HOST_DEVICE static constexpr int halves(int /*tiles*/) { return 1; }

  INR_HOST_DEVICE static const Kept& keep(const SumShare& values) { return values; }
  template <class Activate>
  INR_HOST_DEVICE static Kept activate(const Activate& activate, const SumShare& sums)
  {
    Kept kept;
    INR_UNROLL
    for (int v = 0; v < 8; ++v) {
      kept.values[v] = activate(Sticky(sums.values[v]));
    }
    return kept;
  }
  INR_HOST_DEVICE static Kept load(const Staged* rows, int stride, int lane)
  {
    return LoadWideInputs(rows, stride, lane);
  }
  INR_HOST_DEVICE static Input inputOf(const Kept& kept) { return SplitInputs(kept); }

  /// NaN where a number left float's range on its way.
  template <class Activate> INR_HOST_DEVICE static float output(const Activate& activate, float sum)
  {
    return Sticky(activate(Sticky(sum)));
  }
};

} // namespace cuda
} // namespace inr
