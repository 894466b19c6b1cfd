// SPDX-License-Identifier: BSD-3-Clause
//
// A machine that is the host, as late as a machine may be: it does nothing before somebody waits.
#pragma once

#include "Testing/CUDA/HostMachine.h"

#include <deque>
#include <functional>
#include <utility>
#include <vector>

class LazyMachine
{
public:
  template <class T> using Array = HostMachine::Array<T>;

  /// `late`: else it does everything at once, as beside one that is late.
  explicit LazyMachine(HostLaunch launch = {}, bool late = true) : Host(launch), Late(late) {}

  template <class T> Array<T> allocate(std::int64_t count) const
  {
    return this->Host.allocate<T>(count);
  }
  void requireFree(std::int64_t /*bytes*/, const char* /*what*/) const {}
  template <class T> Array<T> allocatePinned(std::int64_t count) const
  {
    return this->Host.allocate<T>(count);
  }
  template <class T> void beginToMachine(T* to, const T* from, std::int64_t count)
  {
    this->begin([=] { this->Host.copy(to, from, count); });
  }
  template <class T> void toMachine(T* to, const T* from, std::int64_t count)
  {
    std::vector<T> staged(from, from + count);
    this->begin([=, staged = std::move(staged)] { this->Host.copy(to, staged.data(), count); });
  }
  template <class T> void toHost(T* to, const T* from, std::int64_t count)
  {
    this->wait();
    this->Host.copy(to, from, count);
  }
  template <class T> void copy(T* to, const T* from, std::int64_t count)
  {
    this->begin([=] { this->Host.copy(to, from, count); });
  }
  template <class T> void fill(T* to, int byte, std::int64_t count)
  {
    this->begin([=] { this->Host.fill(to, byte, count); });
  }
  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t items, std::int64_t sharedBytes = 0)
  {
    this->begin([=] { this->Host.run(kernel, items, sharedBytes); });
  }
  void wait() { this->goOnTo(this->Done + this->Begun.size()); }
  void after(LazyMachine& other)
  {
    this->begin([&other, end = other.Done + other.Begun.size()] { other.goOnTo(end); });
  }
  bool isIdle() const { return this->Begun.empty(); }

private:
  void begin(std::function<void()> work)
  {
    this->Begun.push_back(std::move(work));
    if (!this->Late) {
      this->wait();
    }
  }
  /// Until so many pieces of work are done, since the beginning.
  void goOnTo(std::size_t end)
  {
    while (this->Done < end) {
      const std::function<void()> work = std::move(this->Begun.front());
      this->Begun.pop_front();
      ++this->Done; // first: it may wait for another machine, and that one for this
      work();
    }
  }

  HostMachine Host;
  bool Late;
  std::deque<std::function<void()>> Begun;
  std::size_t Done = 0;
};
