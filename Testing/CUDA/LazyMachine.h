// SPDX-License-Identifier: BSD-3-Clause
//
// A machine that is the host, as late as a machine may be: it does nothing before somebody waits.
#pragma once

#include "Testing/CUDA/HostMachine.h"

#include <functional>
#include <vector>

class LazyMachine
{
public:
  template <class T> using Array = HostMachine::Array<T>;

  explicit LazyMachine(HostLaunch launch = {}) : Host(launch) {}

  template <class T> Array<T> allocate(std::int64_t count) const
  {
    return this->Host.allocate<T>(count);
  }
  template <class T> Array<T> allocatePinned(std::int64_t count) const
  {
    return this->Host.allocate<T>(count);
  }
  template <class T> void beginToMachine(T* to, const T* from, std::int64_t count)
  {
    this->Begun.push_back([=] { this->Host.copy(to, from, count); });
  }
  template <class T> void toMachine(T* to, const T* from, std::int64_t count)
  {
    std::vector<T> staged(from, from + count);
    this->Begun.push_back(
        [=, staged = std::move(staged)] { this->Host.copy(to, staged.data(), count); });
  }
  template <class T> void toHost(T* to, const T* from, std::int64_t count)
  {
    this->wait();
    this->Host.copy(to, from, count);
  }
  template <class T> void copy(T* to, const T* from, std::int64_t count)
  {
    this->Begun.push_back([=] { this->Host.copy(to, from, count); });
  }
  template <class T> void fill(T* to, int byte, std::int64_t count)
  {
    this->Begun.push_back([=] { this->Host.fill(to, byte, count); });
  }
  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t items, std::int64_t sharedBytes = 0)
  {
    this->Begun.push_back([=] { this->Host.run(kernel, items, sharedBytes); });
  }
  void wait()
  {
    for (const std::function<void()>& work : this->Begun) {
      work();
    }
    this->Begun.clear();
  }

private:
  HostMachine Host;
  std::vector<std::function<void()>> Begun;
};
