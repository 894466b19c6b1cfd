// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/InferenceKernels.h"

#include "Core/Error.h"
#include "Core/Inference/KernelTable.h"
#include "Core/Inference/TileCheck.h"
#include "Core/Inference/TileRegisters.h"

namespace inr {

namespace {

const char* const Tiles = "amx";

[[noreturn]] void RefuseTiles()
{
  throw Error(ErrorCode::Unsupported,
              "the kernel 'amx' needs tile registers, which this processor, its operating system "
              "or this build does not offer; ask for none by name and get the fastest that runs");
}

} // namespace

const EvaluateKernel& EvaluateKernelFor(InstructionSet set)
{
  return INR_KERNEL_FOR(set, Evaluate);
}

InferenceKernels FloatKernels(InstructionSet set)
{
  return {InstructionSetName(set), &EvaluateKernelFor(set), &INR_KERNEL_FOR(set, Grid),
          WeightLayout::Panels};
}

#ifdef INR_X86_KERNELS

InferenceKernels PairKernels()
{
  return {"avx512 bfloat16", &avx512bf16::Evaluate, &avx512bf16::Grid, WeightLayout::Pairs};
}

InferenceKernels TileKernels()
{
  return {"amx bfloat16", &amx::Evaluate, &amx::Grid, WeightLayout::Tiles};
}

InferenceKernels SplitTileKernels()
{
  return {"amx split bfloat16", &amxsplit::Evaluate, &amxsplit::Grid, WeightLayout::SplitTiles};
}

bool IsTileKernelUsable(bool (*mayUseTiles)(), const InferenceKernels& kernels)
{
  return IsUsable(InferencePrecision::BFloat16, InstructionSet::Avx512) && mayUseTiles() &&
         GiveTheSame(kernels, PairKernels());
}

bool IsTileKernelUsable()
{
  static const bool usable = IsTileKernelUsable(MayUseTiles, TileKernels());
  return usable;
}

InferenceKernels ChooseKernels(const std::string& kernel, InferencePrecision precision,
                               bool (*tiles)())
{
  const bool named = kernel == Tiles;
  const InstructionSet set = named ? InstructionSet::Avx512 : ChooseInstructionSet(kernel);
  const bool rounds = precision == InferencePrecision::BFloat16 && IsUsable(precision, set);
  const bool splits = precision == InferencePrecision::SplitBFloat16;
  const bool tiled = named || ((rounds || splits) && kernel.empty());
  if (tiled && tiles()) {
    return rounds ? TileKernels() : splits ? SplitTileKernels() : FloatKernels(set);
  }
  if (named) {
    RefuseTiles();
  }
  return rounds ? PairKernels() : FloatKernels(set);
}

#else

bool IsTileKernelUsable(bool (*)(), const InferenceKernels&) { return false; }

bool IsTileKernelUsable() { return false; }

InferenceKernels ChooseKernels(const std::string& kernel, InferencePrecision, bool (*)())
{
  if (kernel == Tiles) {
    RefuseTiles();
  }
  return FloatKernels(ChooseInstructionSet(kernel));
}

#endif

} // namespace inr
