// SPDX-License-Identifier: BSD-3-Clause
//
// What Launch.h declares, for nvcc: INR_INSTANTIATE(Kernel) makes a kernel one that can be launched.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Device/Launch.h"
#include "CUDA/Device/Runtime.h"

#include <type_traits>

namespace inr {
namespace cuda {

/// Blocks of a kernel that a multiprocessor's registers are to hold at once, where it says that by
/// a member LeastBlocks: it then has no more of them for a thread.
template <class Kernel, class = void> constexpr int LeastBlocksOf = 0;
template <class Kernel>
constexpr int LeastBlocksOf<Kernel, std::void_t<decltype(Kernel::LeastBlocks)>> =
    Kernel::LeastBlocks;

template <class Kernel>
__global__ void __launch_bounds__(Kernel::Threads, LeastBlocksOf<Kernel>)
    Run(const __grid_constant__ Kernel kernel)
{
  DeviceBlock block;
  kernel(block);
}

template <class Kernel> std::int64_t PrepareKernel(std::int64_t sharedBytes)
{
  int device = 0;
  int multiprocessors = 0;
  int mostShared = 0;
  int blocks = 0;
  INR_CUDA(cudaGetDevice(&device));
  INR_CUDA(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device));
  INR_CUDA(cudaDeviceGetAttribute(&mostShared, cudaDevAttrMaxSharedMemoryPerBlockOptin, device));
  // As much as there is, whoever asks: it is the kernel's, and other models run it, too.
  INR_CUDA(
      cudaFuncSetAttribute(Run<Kernel>, cudaFuncAttributeMaxDynamicSharedMemorySize, mostShared));
  INR_CUDA(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, Run<Kernel>, Kernel::Threads,
                                                         static_cast<std::size_t>(sharedBytes)));
  return std::int64_t{multiprocessors} * (blocks > 0 ? blocks : 1);
}

template <class Kernel>
void LaunchKernel(const Kernel& kernel, std::int64_t blocks, std::int64_t sharedBytes,
                  cudaStream_t stream)
{
  Run<Kernel><<<static_cast<unsigned>(blocks), Kernel::Threads,
                static_cast<std::size_t>(sharedBytes), stream>>>(kernel);
  Check(cudaGetLastError(), "kernel launch");
}

} // namespace cuda
} // namespace inr

#define INR_INSTANTIATE(Kernel)                                                                    \
  template std::int64_t inr::cuda::PrepareKernel<Kernel>(std::int64_t);                            \
  template void inr::cuda::LaunchKernel<Kernel>(const Kernel&, std::int64_t, std::int64_t,         \
                                                cudaStream_t)
