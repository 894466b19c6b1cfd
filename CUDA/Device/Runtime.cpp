// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Runtime.h"

#include "Core/Error.h"
#include "Core/Mebibytes.h"

#include <algorithm>
#include <exception>
#include <string>

namespace inr {
namespace cuda {

namespace {

std::string DeviceText()
{
  int device = -1;
  return cudaGetDevice(&device) == cudaSuccess ? "CUDA device " + std::to_string(device) : "CUDA";
}

/// A function of the driver, which this library is not linked with: it loads without one, too.
template <class Function> Function* OfDriver(const char* name)
{
  void* address = nullptr;
#if CUDART_VERSION >= 12050
  INR_CUDA(cudaGetDriverEntryPointByVersion(name, &address, 12000, cudaEnableDefault));
#else
  INR_CUDA(cudaGetDriverEntryPoint(name, &address, cudaEnableDefault));
#endif
  if (address == nullptr) {
    throw Error(ErrorCode::Device, std::string("the NVIDIA driver has no ") + name);
  }
  return reinterpret_cast<Function*>(address);
}

/// A thread's context, which the runtime makes one when it wants one and there is none.
struct ContextCalls
{
  CUresult (*get)(CUcontext*) = OfDriver<CUresult(CUcontext*)>("cuCtxGetCurrent");
  CUresult (*set)(CUcontext) = OfDriver<CUresult(CUcontext)>("cuCtxSetCurrent");
};

const ContextCalls& Contexts()
{
  static const ContextCalls calls;
  return calls;
}

} // namespace

void Check(cudaError_t status, const char* call)
{
  if (status == cudaSuccess) {
    return;
  }
  cudaGetLastError(); // it has been seen: later calls are not to report it again
  throw Error(ErrorCode::Device, DeviceText() + " failed: " + cudaGetErrorString(status) + " (" +
                                     cudaGetErrorName(status) + ", " + call + ")");
}

void Forget(cudaError_t status)
{
  if (status != cudaSuccess) {
    cudaGetLastError();
  }
}

CurrentDevice::CurrentDevice(int ordinal)
{
  if (Contexts().get(&this->Before) != CUDA_SUCCESS) {
    this->Before = nullptr;
  }
  const cudaError_t status = cudaSetDevice(ordinal);
  if (status != cudaSuccess) {
    Contexts().set(this->Before);
    Check(status, "cudaSetDevice(ordinal)");
  }
}

CurrentDevice::~CurrentDevice() { Contexts().set(this->Before); }

Stream::Stream(int device) : Device(device)
{
  const CurrentDevice current(device);
  INR_CUDA(cudaStreamCreateWithFlags(&this->Handle, cudaStreamNonBlocking));
}

Stream::~Stream()
{
  // What is still on its way would otherwise use memory that its owner is about to free.
  try {
    const CurrentDevice current(this->Device);
    Forget(cudaStreamSynchronize(this->Handle));
    Forget(cudaStreamDestroy(this->Handle));
  } catch (const std::exception&) { // it is lost, and its streams with it
  }
}

void Stream::wait() const
{
  const CurrentDevice current(this->Device);
  INR_CUDA(cudaStreamSynchronize(this->Handle));
}

void Stream::settle() const noexcept
{
  try {
    this->wait();
  } catch (const std::exception&) { // nothing is on its way any more
  }
}

Memory::Memory(int device, Place place, std::int64_t bytes) : Device(device), Where(place)
{
  const CurrentDevice current(device);
  const auto size = static_cast<std::size_t>(std::max<std::int64_t>(bytes, 1));
  if (place == Place::Device) {
    INR_CUDA(cudaMalloc(&this->Address, size));
  } else {
    INR_CUDA(cudaHostAlloc(&this->Address, size, cudaHostAllocDefault));
  }
}

Memory::~Memory()
{
  if (this->Address == nullptr) {
    return;
  }
  try {
    const CurrentDevice current(this->Device);
    Forget(this->Where == Place::Device ? cudaFree(this->Address) : cudaFreeHost(this->Address));
  } catch (const std::exception&) { // it is lost, and its memory with it
  }
}

std::int64_t FreeMemory(int device)
{
  const CurrentDevice current(device);
  std::size_t free = 0;
  std::size_t total = 0;
  INR_CUDA(cudaMemGetInfo(&free, &total));
  return std::max<std::int64_t>(
      static_cast<std::int64_t>(free) - static_cast<std::int64_t>(total / 16), 0);
}

void RequireFree(int device, std::int64_t bytes, const char* what)
{
  const CurrentDevice current(device);
  std::size_t free = 0;
  std::size_t total = 0;
  INR_CUDA(cudaMemGetInfo(&free, &total));
  const auto reserve = static_cast<std::int64_t>(total / 16);
  if (bytes + reserve > static_cast<std::int64_t>(free)) {
    throw Error(ErrorCode::Device, std::string(what) + " would take " + InMebibytes(bytes) +
                                       " of " + DeviceText() + ", of whose " +
                                       InMebibytes(static_cast<std::int64_t>(total)) + " " +
                                       InMebibytes(static_cast<std::int64_t>(free)) +
                                       " are free and " + InMebibytes(reserve) + " stay so");
  }
}

} // namespace cuda
} // namespace inr
