// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

/// INR_KERNEL_FOR picks `name` out of the namespace built for `set`, a usable InstructionSet;
/// INR_BFLOAT16_KERNEL_OR that of the build for bfloat16 where `precision` is that, else `other`.
#ifdef INR_X86_KERNELS
#define INR_KERNEL_FOR(set, name)                                                                  \
  ((set) == ::inr::InstructionSet::Avx512 ? ::inr::avx512::name                                    \
   : (set) == ::inr::InstructionSet::Avx2 ? ::inr::avx2::name                                      \
                                          : ::inr::baseline::name)
#define INR_BFLOAT16_KERNEL_OR(other, precision, name)                                             \
  ((precision) == ::inr::InferencePrecision::BFloat16 ? ::inr::avx512bf16::name : (other))
#else
#define INR_BFLOAT16_KERNEL_OR(other, precision, name) (static_cast<void>(precision), (other))
#define INR_KERNEL_FOR(set, name) (static_cast<void>(set), ::inr::baseline::name)
#endif
