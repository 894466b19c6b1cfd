// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/CacheLine.h"
#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"
#include "Core/Training/Descent/AdamSchedule.h"

#include <cstdint>

namespace inr {

/// Samples that go through network and back together.
constexpr std::int64_t TrainBlockSize = 512;

/// Floats from a row of a block to the next: a line more than there are samples, as rows that are a
/// power of two apart would share few places of a cache and drive each other out.
constexpr std::int64_t TrainRowSize = TrainBlockSize + CacheLineFloats;

/// One block of samples and where their gradients go.
struct TrainBlock
{
  const float* targets; ///< `count` normalised values; NaN = carries no gradient
  std::int64_t count;   ///< 1 to TrainBlockSize
  float gradientScale;  ///< 1 / (samples in the mini-batch)
  /// Encoded features; overwritten by d loss / d encoded feature. Row f of encodedWidth starts at
  /// f * TrainRowSize.
  float* encoded;
  /// d loss / d MLP weight, in the parameter vector's order; added to.
  float* weightGradient;
  double loss; ///< sum of (output - target)^2 over the block; out
};

/// Parameters of a level that are marked and updated together; an entry lies within a line.
constexpr std::int64_t GradientLine = 8;

/// d loss / d parameter of a level of the grid, and which lines of it may differ from zero.
struct LevelGradient
{
  float* values;
  std::uint8_t* touched; ///< one per line; 0 = all zero
};

/// A run of Adam updates (Kingma and Ba, "Adam", ICLR 2015).
struct AdamRun
{
  float* parameters;
  float* gradients;
  float* firstMoments;
  float* secondMoments;
  float beta1, epsilon;
  float decay; ///< L2 regularisation: decay * parameter joins the gradient
};

/// An update of a layer's weights by orthogonalised momentum: of the matrix that gradient and
/// momentum come to, singular values are made nearly 1 (K. Jordan et al., "Muon", 2024).
struct OrthogonalRun
{
  float* parameters; ///< rows x columns, row by row, and so are the others
  const float* gradients;
  float* momentum;
  int rows, columns;
  float kept; ///< share of the momentum
  float rate; ///< what the nearly orthogonal matrix is multiplied by
};

/// What one gradient step needs, for one instruction set.
///
/// Encoded features and their gradients have a block of encodedWidth * TrainRowSize floats per
/// TrainBlockSize samples of the batch.
struct TrainKernel
{
  std::int64_t (*workspace)(const ModelView& model); ///< of backpropagate, floats
  /// One level's features of `count` samples.
  void (*encode)(const ModelView& model, int level, const float* xyz, std::int64_t count,
                 float* encoded);
  /// Nothing is read of the workspace that was not written before; it may begin anywhere.
  void (*backpropagate)(const ModelView& model, TrainBlock& block, float* workspace);
  /// Adds one level's share of d loss / d grid parameter. Serial, so that the order of additions is
  /// fixed.
  void (*scatter)(const ModelView& model, int level, const float* xyz, std::int64_t count,
                  const float* encodedGradient, const LevelGradient& gradient);
  void (*adam)(const AdamRun& run, std::int64_t count, AdamStep step);
  /// Updates those of `count` parameters of a level that lie in touched lines and whose gradient is
  /// not zero, and makes gradients and marks zero. The first parameter begins a line; counts[k]
  /// says how often parameter k was updated.
  void (*adamSparse)(const AdamRun& run, std::int64_t count, std::uint8_t* touched,
                     float learningRate, std::uint16_t* counts, const AdamSchedule& schedule);
  std::int64_t (*orthogonalWorkspace)(int rows, int columns); ///< floats
  /// Where the whole gradient is zero the layer stays: the step would be as long as ever, however
  /// small the momentum has become. Where an element is not finite, no weight is afterwards.
  void (*orthogonal)(const OrthogonalRun& run, float* workspace);
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
