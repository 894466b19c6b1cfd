// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"

#include <cstdint>

namespace inr {

/// Network outputs at scattered points, for one instruction set. The model must be packed
/// for its precision.
struct EvaluateKernel
{
  /// Floats of scratch memory that `evaluate` needs.
  std::int64_t (*workspace)(const ModelView& model);
  /// `xyz` holds `count` interleaved positions.
  void (*evaluate)(const ModelView& model, const float* xyz, std::int64_t count, float* values,
                   float* workspace);
};

/// The kernel built for `set`; both must be usable.
const EvaluateKernel& EvaluateKernelFor(InstructionSet set,
                                        InferencePrecision precision = InferencePrecision::Float32);

namespace baseline {
extern const EvaluateKernel Evaluate;
}
namespace avx2 {
extern const EvaluateKernel Evaluate;
}
namespace avx512 {
extern const EvaluateKernel Evaluate;
}
namespace avx512bf16 {
extern const EvaluateKernel Evaluate;
}

} // namespace inr
