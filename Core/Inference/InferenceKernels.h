// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/EvaluateKernel.h"
#include "Core/Inference/GridKernel.h"
#include "Core/Inference/ModelView.h"

#include <string>

namespace inr {

/// Kernels that go together, and what they want of a model.
struct InferenceKernels
{
  std::string name; ///< what Evaluator::kernel() says
  const EvaluateKernel* points;
  const GridKernel* lattices;
  WeightLayout layout;
};

/// float32 by the instructions of `set`, which must be usable.
InferenceKernels FloatKernels(InstructionSet set);

#ifdef __x86_64__
/// bfloat16 by AVX512-BF16; IsUsable(BFloat16, Avx512) says whether it may be used.
InferenceKernels PairKernels();
/// bfloat16 by tile registers (AMX); IsTileKernelUsable() says whether it may be used.
InferenceKernels TileKernels();
/// Sums of two bfloat16 numbers by the same.
InferenceKernels SplitTileKernels();
#endif

/// Whether this process may use tile registers and what they give is what AVX512-BF16 gives. Asked
/// and tried once, at the first call, whichever thread makes it.
bool IsTileKernelUsable();

/// The same of other kernels, with another answer to whether tiles may be used; each time anew.
bool IsTileKernelUsable(bool (*mayUseTiles)(), const InferenceKernels& kernels);

/// Those that compute with `precision`, or float32 where that is not to be had. `kernel` is an
/// instruction set's name, "amx" (that of AVX-512 but for bfloat16), or empty for the fastest; a
/// name gets that or Error(Unsupported). `tiles` says whether those of tiles are usable.
InferenceKernels ChooseKernels(const std::string& kernel, InferencePrecision precision,
                               bool (*tiles)() = IsTileKernelUsable);

} // namespace inr
