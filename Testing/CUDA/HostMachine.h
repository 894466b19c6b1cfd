// SPDX-License-Identifier: BSD-3-Clause
//
// A machine (CUDA/Device/Machine.h) that is the host: the kernels' threads take turns.
#pragma once

#include "Testing/CUDA/Emulated.h"

#include <algorithm>
#include <cstring>
#include <memory>

class HostMachine
{
public:
  /// Begins as bytes 0xff, which are NaNs; a sanitizer sees where its end is.
  template <class T> class Array
  {
  public:
    explicit Array(std::int64_t count)
        : Bytes(new unsigned char[static_cast<std::size_t>(count) * sizeof(T)]), Count(count)
    {
      std::memset(this->Bytes.get(), 0xff, static_cast<std::size_t>(count) * sizeof(T));
    }
    T* data() const { return reinterpret_cast<T*>(this->Bytes.get()); }
    std::int64_t size() const { return this->Count; }

  private:
    std::unique_ptr<unsigned char[]> Bytes;
    std::int64_t Count;
  };

  explicit HostMachine(HostLaunch launch = {}) : Launch(launch) {}

  template <class T> Array<T> allocate(std::int64_t count) const
  {
    return Array<T>(std::max<std::int64_t>(count, 1));
  }
  void requireFree(std::int64_t /*bytes*/, const char* /*what*/) const {}
  template <class T> Array<T> allocatePinned(std::int64_t count) const
  {
    return this->allocate<T>(count);
  }
  template <class T> void beginToMachine(T* to, const T* from, std::int64_t count) const
  {
    this->copy(to, from, count);
  }
  template <class T> void toMachine(T* to, const T* from, std::int64_t count) const
  {
    this->copy(to, from, count);
  }
  template <class T> void toHost(T* to, const T* from, std::int64_t count) const
  {
    this->copy(to, from, count);
  }
  template <class T> void copy(T* to, const T* from, std::int64_t count) const
  {
    std::memcpy(static_cast<void*>(to), from, static_cast<std::size_t>(count) * sizeof(T));
  }
  template <class T> void fill(T* to, int byte, std::int64_t count) const
  {
    std::memset(static_cast<void*>(to), byte, static_cast<std::size_t>(count) * sizeof(T));
  }
  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t items, std::int64_t sharedBytes = 0) const
  {
    if (items > 0) {
      this->Launch.run(kernel, sharedBytes);
    }
  }
  void wait() const {}
  void after(const HostMachine& /*other*/) const {}
  bool isIdle() const { return true; }

private:
  HostLaunch Launch;
};
