// SPDX-License-Identifier: BSD-3-Clause
//
// The only door between the host's code and that of nvcc. Kernels are instantiated in Launch*.cu,
// by LaunchDefinition.cuh.
#pragma once

#include <cstdint>
#include <cuda_runtime_api.h>

namespace inr {
namespace cuda {

/// Lets a kernel use all shared memory that a block may have; returns how many of its blocks are in
/// work at once on the calling thread's device where each takes so much.
template <class Kernel> std::int64_t PrepareKernel(std::int64_t sharedBytes);

/// Begins a kernel, behind what is in the stream. `blocks`: at least 1.
template <class Kernel>
void LaunchKernel(const Kernel& kernel, std::int64_t blocks, std::int64_t sharedBytes,
                  cudaStream_t stream);

} // namespace cuda
} // namespace inr
