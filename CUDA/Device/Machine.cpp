// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Machine.h"

namespace inr {
namespace cuda {

void GpuMachine::after(const GpuMachine& other) const
{
  const CurrentDevice current(this->Device);
  cudaEvent_t event = nullptr;
  INR_CUDA(cudaEventCreateWithFlags(&event, cudaEventDisableTiming));
  const cudaError_t recorded = cudaEventRecord(event, other.Work.get());
  const cudaError_t waiting =
      recorded == cudaSuccess ? cudaStreamWaitEvent(this->Work.get(), event, 0) : recorded;
  Forget(cudaEventDestroy(event)); // which goes on until it has happened
  Check(waiting, "waiting for another stream");
}

bool GpuMachine::isIdle() const
{
  const CurrentDevice current(this->Device);
  const cudaError_t status = cudaStreamQuery(this->Work.get());
  if (status == cudaErrorNotReady) {
    cudaGetLastError(); // is no error, and the next one who asks for errors shall not see it
    return false;
  }
  Check(status, "cudaStreamQuery");
  return true;
}

void GpuMachine::copyBytes(void* to, const void* from, std::int64_t bytes) const
{
  const CurrentDevice current(this->Device);
  INR_CUDA(cudaMemcpyAsync(to, from, static_cast<std::size_t>(bytes), cudaMemcpyDeviceToDevice,
                           this->Work.get()));
}

void GpuMachine::fillBytes(void* to, int byte, std::int64_t bytes) const
{
  const CurrentDevice current(this->Device);
  INR_CUDA(cudaMemsetAsync(to, byte, static_cast<std::size_t>(bytes), this->Work.get()));
}

} // namespace cuda
} // namespace inr
