// SPDX-License-Identifier: BSD-3-Clause
//
// Owners of what the CUDA runtime hands out. Everything is checked: what fails throws Error(Device)
// with the call, the device and the runtime's words; destructors, which must not throw, ignore it.
#pragma once

#include <cstdint>
#include <cuda.h>
#include <cuda_runtime_api.h>
#include <utility>

namespace inr {
namespace cuda {

/// Throws where `status` is no success. `call`: its text.
void Check(cudaError_t status, const char* call);

/// Where nobody can be told: else the thread's next launch would report it.
void Forget(cudaError_t status);

#define INR_CUDA(call) ::inr::cuda::Check((call), #call)

/// Makes a device's primary context the calling thread's, for as long as this lives: the
/// application may have chosen another device, or made a context of its own on the same one, which
/// the runtime would use. What comes back is the driver's context, which may be none: to choose a
/// device makes a context on it since CUDA 12, and a thread that has chosen none is said to have
/// device 0. For the same reason whatever wants a context at all is called within one of these.
class CurrentDevice
{
public:
  explicit CurrentDevice(int ordinal);
  ~CurrentDevice();
  CurrentDevice(const CurrentDevice&) = delete;
  CurrentDevice& operator=(const CurrentDevice&) = delete;

private:
  CUcontext Before = nullptr;
};

/// A queue of work that waits for none but its own.
class Stream
{
public:
  explicit Stream(int device);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  cudaStream_t get() const { return this->Handle; }
  int device() const { return this->Device; }
  void wait() const;            ///< until all is done
  void settle() const noexcept; ///< the same, whatever fails

private:
  int Device;
  cudaStream_t Handle = nullptr;
};

/// Untyped memory of a device, or of the host where the device can copy from and to it by itself.
class Memory
{
public:
  enum class Place { Device, Pinned };

  Memory(int device, Place place, std::int64_t bytes);
  ~Memory();
  Memory(Memory&& other) noexcept
      : Device(other.Device), Where(other.Where), Address(std::exchange(other.Address, nullptr))
  {}
  Memory& operator=(Memory&&) = delete;

  void* get() const { return this->Address; }

private:
  int Device;
  Place Where;
  void* Address = nullptr;
};

/// `count` numbers of it, not initialised.
template <class T> class Array
{
public:
  Array(int device, Memory::Place place, std::int64_t count)
      : Bytes(device, place, count * static_cast<std::int64_t>(sizeof(T))), Count(count)
  {}

  T* data() const { return static_cast<T*>(this->Bytes.get()); }
  std::int64_t size() const { return this->Count; }

private:
  Memory Bytes;
  std::int64_t Count;
};

/// Copies behind what is in the stream.
template <class T> void CopyToDevice(T* to, const T* from, std::int64_t count, const Stream& stream)
{
  const CurrentDevice current(stream.device());
  INR_CUDA(cudaMemcpyAsync(to, from, static_cast<std::size_t>(count) * sizeof(T),
                           cudaMemcpyHostToDevice, stream.get()));
}
template <class T> void CopyToHost(T* to, const T* from, std::int64_t count, const Stream& stream)
{
  const CurrentDevice current(stream.device());
  INR_CUDA(cudaMemcpyAsync(to, from, static_cast<std::size_t>(count) * sizeof(T),
                           cudaMemcpyDeviceToHost, stream.get()));
}

/// Bytes that may be taken: a sixteenth of the device's memory stays for whoever draws with it.
std::int64_t FreeMemory(int device);
/// Throws Error(Device) with figures unless so many bytes, and a sixteenth of the device's memory
/// for whoever draws with it, are free. `what`: "the model".
void RequireFree(int device, std::int64_t bytes, const char* what);

} // namespace cuda
} // namespace inr
