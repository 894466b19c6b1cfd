// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Training/Quality/PsnrEstimate.h"

#include <cstdint>

namespace inr {

struct QuantiseLimits
{
  double loss = 0.1; ///< dB of the estimated PSNR
  /// Bytes that the file should take at most; 0 = any number. For it steps become up to 64 times as
  /// coarse as the loss allows; where that is not enough they stay as they were.
  std::int64_t fileSize = 0;
};

/// For a file of the volume's bytes / `ratio` (0 = any size), with room for the ranges of the
/// model's macro-cells, which are measured later.
QuantiseLimits LimitsForRatio(const Model& model, double ratio);

/// Chooses `model.steps` and makes the parameters multiples of them: the coarsest ones that keep
/// the limits, to an eighth of a power of two. Groups share the allowed error so that a bit more
/// would help as much in any of them: with n parameters and an error of s * step^2 in the output,
/// step is proportional to sqrt(n / s). What the padding of a network multiplies becomes 0.
///
/// `model.storedAs` becomes Quantised; or Half, with the parameters as they were, when not even the
/// finest steps keep the loss, or the estimate has too few finite voxels to tell. `check` stops it
/// by throwing. The result does not depend on the number of threads.
void Quantise(Model& model, const PsnrEstimate& estimate, const EvaluateKernel& kernel,
              const QuantiseLimits& limits, const StopCheck& check = StopCheck());

} // namespace inr
