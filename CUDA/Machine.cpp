// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Machine.h"

namespace inr {
namespace cuda {

void GpuMachine::copyBytes(void* to, const void* from, std::int64_t bytes) const
{
  INR_CUDA(cudaMemcpyAsync(to, from, static_cast<std::size_t>(bytes), cudaMemcpyDeviceToDevice,
                           this->Work.get()));
}

void GpuMachine::fillBytes(void* to, int byte, std::int64_t bytes) const
{
  INR_CUDA(cudaMemsetAsync(to, byte, static_cast<std::size_t>(bytes), this->Work.get()));
}

} // namespace cuda
} // namespace inr
