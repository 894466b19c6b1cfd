// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

/// INR_KERNEL_FOR picks `name` out of the namespace built for `set`, a usable InstructionSet.
#ifdef INR_X86_KERNELS
#define INR_KERNEL_FOR(set, name)                                                                  \
  ((set) == ::inr::InstructionSet::Avx512 ? ::inr::avx512::name                                    \
   : (set) == ::inr::InstructionSet::Avx2 ? ::inr::avx2::name                                      \
                                          : ::inr::baseline::name)
#else
#define INR_KERNEL_FOR(set, name) (static_cast<void>(set), ::inr::baseline::name)
#endif
