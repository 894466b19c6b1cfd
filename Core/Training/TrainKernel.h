// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"

#include <cstdint>

namespace inr {

/// Samples that go through network and back together.
constexpr std::int64_t TrainBlockSize = 512;

/// One block of samples and where their gradients go.
struct TrainBlock
{
  const float* xyz;     ///< `count` interleaved positions
  const float* targets; ///< `count` normalised values; NaN = carries no gradient
  std::int64_t count;   ///< 1 to TrainBlockSize
  float gradientScale;  ///< 1 / (samples in the mini-batch)
  /// d loss / d encoded feature: row f of encodedWidth starts at f * TrainBlockSize; overwritten.
  float* encodedGradient;
  /// d loss / d MLP weight, in the parameter vector's order; added to.
  float* weightGradient;
  double loss; ///< sum of (output - target)^2 over the block; out
};

/// A run of Adam updates (Kingma and Ba, "Adam", ICLR 2015).
struct AdamRun
{
  float* parameters;
  const float* gradients;
  float* firstMoments;
  float* secondMoments;
  float beta1, beta2, epsilon;
  float decay; ///< L2 regularisation: decay * parameter joins the gradient
};

/// What one gradient step needs, for one instruction set.
struct TrainKernel
{
  std::int64_t (*workspace)(const ModelView& model); ///< floats
  void (*backpropagate)(const ModelView& model, TrainBlock& block, float* workspace);
  /// Adds one level's share of d loss / d grid parameter. `encodedGradient` is the whole batch's, a
  /// block of encodedWidth * TrainBlockSize floats per TrainBlockSize samples. Serial, so that the
  /// order of additions is fixed.
  void (*scatter)(const ModelView& model, int level, const float* xyz, std::int64_t count,
                  const float* encodedGradient, float* gridGradient);
  /// Updates `count` parameters with one learning rate (bias correction included).
  void (*adam)(const AdamRun& run, std::int64_t count, float learningRate);
  /// Updates the table entries whose gradient is not zero; each has its own step count t and bias
  /// correction corrections[min(t, last)].
  void (*adamSparse)(const AdamRun& run, std::int64_t entries, int features, float learningRate,
                     std::uint32_t* steps, const float* corrections, std::uint32_t last);
};

/// The kernel built for `set`, which must be usable.
const TrainKernel& TrainKernelFor(InstructionSet set);

namespace baseline {
extern const TrainKernel Train;
}
namespace avx2 {
extern const TrainKernel Train;
}
namespace avx512 {
extern const TrainKernel Train;
}

} // namespace inr
