// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"

#include <cstdint>

namespace inr {

/// Network outputs at scattered points, for one instruction set. The model must be packed
/// for it.
struct EvaluateKernel
{
  /// Floats of scratch memory that `evaluate` needs.
  std::int64_t (*workspace)(const ModelView& model);
  /// `xyz` holds `count` interleaved positions.
  void (*evaluate)(const ModelView& model, const float* xyz, std::int64_t count, float* values,
                   float* workspace);
};

/// The kernel for float32 built for `set`, which must be usable; see InferenceKernels.h for others.
const EvaluateKernel& EvaluateKernelFor(InstructionSet set);

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
namespace amx {
extern const EvaluateKernel Evaluate;
}
namespace amxsplit {
extern const EvaluateKernel Evaluate;
}
#ifdef INR_ISA // whatever the build at hand is called
namespace INR_ISA {
extern const EvaluateKernel Evaluate;
}
#endif

} // namespace inr
