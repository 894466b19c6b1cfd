// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Runtime.h"

#include "Core/Error.h"

#include <algorithm>
#include <string>

namespace inr {
namespace cuda {

namespace {

std::string MiB(std::int64_t bytes)
{
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB";
}

std::string DeviceText()
{
  int device = -1;
  return cudaGetDevice(&device) == cudaSuccess ? "CUDA device " + std::to_string(device) : "CUDA";
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

CurrentDevice::CurrentDevice(int ordinal)
{
  INR_CUDA(cudaGetDevice(&this->Before));
  this->Changed = this->Before != ordinal;
  if (this->Changed) {
    INR_CUDA(cudaSetDevice(ordinal));
  }
}

CurrentDevice::~CurrentDevice()
{
  if (this->Changed && cudaSetDevice(this->Before) != cudaSuccess) {
    cudaGetLastError(); // whoever asks next is not to be told of it
  }
}

Stream::Stream(int device) : Device(device)
{
  const CurrentDevice current(device);
  INR_CUDA(cudaStreamCreateWithFlags(&this->Handle, cudaStreamNonBlocking));
}

Stream::~Stream()
{
  // What is still on its way would otherwise use memory that its owner is about to free.
  cudaStreamSynchronize(this->Handle);
  cudaStreamDestroy(this->Handle);
}

void Stream::wait() const { INR_CUDA(cudaStreamSynchronize(this->Handle)); }

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
  int before = -1;
  const bool known = cudaGetDevice(&before) == cudaSuccess;
  cudaSetDevice(this->Device);
  this->Where == Place::Device ? cudaFree(this->Address) : cudaFreeHost(this->Address);
  if (known && cudaSetDevice(before) != cudaSuccess) {
    cudaGetLastError();
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
    throw Error(ErrorCode::Device, std::string(what) + " would take " + MiB(bytes) + " of " +
                                       DeviceText() + ", of whose " +
                                       MiB(static_cast<std::int64_t>(total)) + " " +
                                       MiB(static_cast<std::int64_t>(free)) + " are free and " +
                                       MiB(reserve) + " stay so");
  }
}

} // namespace cuda
} // namespace inr
