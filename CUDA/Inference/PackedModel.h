// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Inference/Kernels/PointKernels.h"
#include "CUDA/Inference/Precision.h"
#include "Core/Model/Model.h"

#include <string>
#include <vector>

namespace inr {
namespace cuda {

/// Throws Error(InvalidModel) where Core's evaluator would: when the parameter count does not fit
/// the description or a parameter is NaN or infinite.
void RequireValid(const Model& model);

/// Why a model cannot be evaluated in half precision, or nothing: layers of more than
/// MostFusedNeurons, or a parameter beyond +-65504.
std::string WhyNotHalf(const Model& model);

/// A model as the fused kernel wants it, in the host's memory. Parameters are rounded to halves:
/// without loss where the file stored them so; what is below 2^-25 becomes zero.
struct PackedModel
{
  /// Throws what RequireValid throws, and Error(Unsupported) with WhyNotHalf.
  explicit PackedModel(const Model& model);

  /// Its view; the tables may lie elsewhere.
  FusedModel view(const LevelView* levels, const HalfBits* features,
                  const WeightShare* weights) const;
  FusedModel view() const
  {
    return this->view(this->levels.data(), this->features.data(), this->weights.data());
  }

  std::vector<LevelView> levels;
  std::vector<HalfBits> features;
  std::vector<WeightShare> weights; ///< see FusedNetwork
  int inputTiles;
  int neuronTiles; ///< of a hidden layer: 1, 2, 4 or 8

private:
  int Features;
  GridInterpolation Interpolation;
  int HiddenLayers;
  Activation Hidden;
  Activation Output;
};

/// Where a fused kernel has what in shared memory. Fills up to `roomy` bytes where that does; what
/// cannot be left out may take up to `most`. Throws Error(Unsupported) where even that is too
/// little: models with very many features per sample.
FusedShared PlanShared(const PackedModel& model, bool bricks, std::int64_t roomy,
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
