// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cuda_runtime_api.h>

/// Begins products of tiles on the tensor cores, from registers and to registers: what they do at
/// most. Returns how many multiplications and additions of a pair it will have done.
std::int64_t LaunchTensorCeiling(int multiprocessors, float* sink, cudaStream_t stream);
