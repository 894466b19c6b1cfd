// SPDX-License-Identifier: BSD-3-Clause
//
// Where kernels run, for code that does not care which it is: such code is a template over a
// machine. This one is a GPU; tests have one that is the host, Testing/CUDA/HostMachine.h.
//
// A machine has memory of its own, and does what it is told in order; only toHost and wait wait for
// it. What is in its memory may be passed to kernels, and to nobody else.
#pragma once

#include "CUDA/Device/Launch.h"
#include "CUDA/Device/Runtime.h"

#include <algorithm>
#include <cstdint>
#include <map>

namespace inr {
namespace cuda {

/// A stream of a GPU. All throw Error(Device) where that fails, or has no memory.
class GpuMachine
{
public:
  /// Numbers in its memory: data(), size(). May be moved.
  template <class T> using Array = cuda::Array<T>;

  explicit GpuMachine(int device) : Device(device), Work(device) {}

  /// Not initialised.
  template <class T> Array<T> allocate(std::int64_t count) const
  {
    return Array<T>(this->Device, Memory::Place::Device, std::max<std::int64_t>(count, 1));
  }
  /// Throws with figures where that would be too much; see RequireFree.
  void requireFree(std::int64_t bytes, const char* what) const
  {
    RequireFree(this->Device, bytes, what);
  }
  /// In the host's memory, from where it copies by itself. Not initialised.
  template <class T> Array<T> allocatePinned(std::int64_t count) const
  {
    return Array<T>(this->Device, Memory::Place::Pinned, std::max<std::int64_t>(count, 1));
  }
  /// Begins to copy from there; what is there stays as it is until somebody has waited.
  template <class T> void beginToMachine(T* to, const T* from, std::int64_t count) const
  {
    CopyToDevice(to, from, count, this->Work);
  }
  /// Copies, from memory that may change when this has returned.
  template <class T> void toMachine(T* to, const T* from, std::int64_t count) const
  {
    CopyToDevice(to, from, count, this->Work);
    this->Work.wait(); // pageable memory may still be read otherwise
  }
  /// Copies when all is done that was begun before.
  template <class T> void toHost(T* to, const T* from, std::int64_t count) const
  {
    CopyToHost(to, from, count, this->Work);
    this->Work.wait();
  }
  template <class T> void copy(T* to, const T* from, std::int64_t count) const
  {
    this->copyBytes(to, from, count * static_cast<std::int64_t>(sizeof(T)));
  }
  /// Sets every byte.
  template <class T> void fill(T* to, int byte, std::int64_t count) const
  {
    this->fillBytes(to, byte, count * static_cast<std::int64_t>(sizeof(T)));
  }

  /// Begins a kernel whose threads share out `items`, of which there may be none. It goes on by
  /// strides of all threads that there are, which may be fewer.
  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t items, std::int64_t sharedBytes = 0)
  {
    if (items > 0) {
      const std::int64_t most = this->blocksAtOnce<Kernel>(sharedBytes);
      const std::int64_t wanted = (items + Kernel::Threads - 1) / Kernel::Threads;
      const CurrentDevice current(this->Device);
      LaunchKernel(kernel, std::min(most, wanted), sharedBytes, this->Work.get());
    }
  }

  void wait() const { this->Work.wait(); }
  /// What is begun here from now on waits for what the other one has been told so far.
  void after(const GpuMachine& other) const;
  bool isIdle() const; ///< all is done that was begun
  int device() const { return this->Device; }
  const Stream& stream() const { return this->Work; }

private:
  void copyBytes(void* to, const void* from, std::int64_t bytes) const;
  void fillBytes(void* to, int byte, std::int64_t bytes) const;
  /// Asked once: the answer takes longer than a launch.
  template <class Kernel> std::int64_t blocksAtOnce(std::int64_t sharedBytes)
  {
    static const char kernel = 0; // another one's is elsewhere
    const std::pair key(&kernel, sharedBytes);
    auto known = this->Blocks.find(key);
    if (known == this->Blocks.end()) {
      const CurrentDevice current(this->Device);
      known = this->Blocks.emplace(key, PrepareKernel<Kernel>(sharedBytes)).first;
    }
    return known->second;
  }

  int Device;
  Stream Work;
  std::map<std::pair<const char*, std::int64_t>, std::int64_t> Blocks; ///< at once, of a kernel
};

} // namespace cuda
} // namespace inr
