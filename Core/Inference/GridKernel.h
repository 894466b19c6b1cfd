// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"

#include <cstdint>

namespace inr {

/// One axis of a lattice of samples: rising coordinates in [0, 1], one at least.
struct LatticeAxis
{
  const float* u;
  std::int64_t count;
};

/// Network outputs on a regular lattice, for one instruction set. The model must be packed
/// for it.
struct GridKernel
{
  /// Bytes of scratch memory that `evaluate` needs.
  std::int64_t (*workspace)(const ModelView& model);
  /// x fastest in `values`.
  void (*evaluate)(const ModelView& model, const LatticeAxis (&axes)[3], float* values,
                   void* workspace);
};

namespace baseline {
extern const GridKernel Grid;
}
namespace avx2 {
extern const GridKernel Grid;
}
namespace avx512 {
extern const GridKernel Grid;
}
namespace avx512bf16 {
extern const GridKernel Grid;
}
namespace amx {
extern const GridKernel Grid;
}
namespace amxsplit {
extern const GridKernel Grid;
}
#ifdef INR_ISA // whatever the build at hand is called
namespace INR_ISA {
extern const GridKernel Grid;
}
#endif

} // namespace inr
