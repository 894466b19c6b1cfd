// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Inference/Kernels/PointKernels.h"
#include "Core/Model/Model.h"

#include <string>
#include <vector>

namespace inr {
namespace cuda {

/// Why a fused kernel cannot evaluate a model, or nothing: layers of more than MostFusedNeurons.
std::string WhyNotFused(const Model& model);

/// Why a model cannot be evaluated in half precision, or nothing: that, or a parameter beyond
/// +-65504.
std::string WhyNotHalf(const Model& model);

/// A model as the fused kernels want it, in the host's memory. As HalfNumbers, parameters are
/// rounded to halves: without loss where the file stored them so; what is below 2^-25 becomes zero.
/// As FloatNumbers, weights lose 2^-22 of themselves at most.
template <class Numbers> struct PackedModel
{
  using Feature = typename Numbers::Feature;
  using Weight = typename Numbers::Weight;

  /// Throws what CheckedLayout throws, and Error(Unsupported) with WhyNotHalf, or WhyNotFused.
  /// `features`: whether they are packed, too.
  explicit PackedModel(const Model& model, bool features = true);

  /// Its view; the tables may lie elsewhere.
  FusedModel<Numbers> view(const LevelView* levels, const Feature* features,
                           const Weight* weights) const;
  FusedModel<Numbers> view() const
  {
    return this->view(this->levels.data(), this->features.data(), this->weights.data());
  }

  std::vector<LevelView> levels;
  std::vector<Feature> features;
  std::vector<Weight> weights; ///< see FusedNetwork
  bool hasSecond;              ///< the same
  int inputTiles;
  int neuronTiles; ///< of a hidden layer: 1, 2, 4 or 8

private:
  int Features;
  GridInterpolation Interpolation;
  int HiddenLayers;
  Activation Hidden;
  Activation Output;
};

extern template struct PackedModel<HalfNumbers>;
extern template struct PackedModel<FloatNumbers>;

/// Whether the fused kernels have enough shared memory where a block has `most` bytes of it: for
/// models of very many levels there is none.
template <class Numbers> bool FitsShared(const PackedModel<Numbers>& model, std::int64_t most);

/// Where a fused kernel has what in shared memory. Fills up to `roomy` bytes where that does; what
/// cannot be left out may take up to `most`. Throws Error(Unsupported) where even that is too
/// little.
template <class Numbers>
FusedShared PlanShared(const PackedModel<Numbers>& model, bool bricks, std::int64_t roomy,
                       std::int64_t most);

/// Calls `function(FeatureCount<T>())` for the T that is `tiles`: 1, 2, 4 or 8.
template <class Function> void WithTiles(int tiles, const Function& function)
{
  WithFeatures(tiles, function);
}

/// The host's tables behind a FloatModel.
struct FloatTables
{
  /// Of a valid model. `weights`, `features`: where the two parts of the parameters lie for whoever
  /// runs the kernel, the latter aligned to 16 bytes.
  FloatTables(const Model& model, const float* weights, const float* features);

  FloatModel view(const LevelView* levels, const LayerView* layers) const;

  std::vector<LevelView> levels;
  std::vector<LayerView> layers;

private:
  FloatModel View;
};

/// Floats of scratch memory for each thread of a float32 kernel.
inline std::int64_t ScratchPerThread(const FloatModel& model)
{
  return 2 * std::int64_t{model.widest};
}

} // namespace cuda
} // namespace inr
