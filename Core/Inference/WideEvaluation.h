// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/ModelView.h"

namespace inr {

/// Where the wide evaluation saturates: no product with a float, nor a sum of as many of them as a
/// layer has, leaves double's range.
constexpr double WideLimit = 1e266;

/// The network's output at one position (three floats) in float64 arithmetic, for what float cannot
/// hold: a hundred times slower than a kernel, and the same for every instruction set. What an
/// activation gives saturates at +-WideLimit and the result at +-the largest float, so that finite
/// parameters never give an infinite value or a NaN. Cells and weights in them are those of the
/// kernels.
float EvaluateWide(const ModelView& model, const float* position);

} // namespace inr
