// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Testing/CUDA/HostMachine.h"

#include <limits>
#include <memory>

/// What the test and machines know of each other.
struct FailingOrders
{
  int failsAt = std::numeric_limits<int>::max(); ///< that order and all that follow; 0 = the first
  int orders = 0;                                ///< so far
  int kernels = 0;                               ///< of these, that were run
  bool lies = false; ///< what is copied to the host is not what there is
};

/// A machine that is lost at some order, and does nothing from then on; or that computes wrongly.
class FailingMachine : public HostMachine
{
public:
  explicit FailingMachine(std::shared_ptr<FailingOrders> orders) : Orders(std::move(orders)) {}

  template <class T> Array<T> allocate(std::int64_t count) const
  {
    this->order();
    return this->HostMachine::allocate<T>(count);
  }
  template <class T> void toMachine(T* to, const T* from, std::int64_t count) const
  {
    this->order();
    this->HostMachine::toMachine(to, from, count);
  }
  template <class T> void toHost(T* to, const T* from, std::int64_t count) const
  {
    this->order();
    this->HostMachine::toHost(to, from, count);
    if constexpr (std::is_same_v<T, float>) {
      for (std::int64_t k = 0; this->Orders->lies && k < count; ++k) {
        to[k] = 0.5f * to[k] + 0.1f;
      }
    }
  }
  void requireFree(std::int64_t bytes, const char* what) const
  {
    this->order();
    this->HostMachine::requireFree(bytes, what);
  }
  template <class T> Array<T> allocatePinned(std::int64_t count) const
  {
    this->order();
    return this->HostMachine::allocatePinned<T>(count);
  }
  template <class T> void beginToMachine(T* to, const T* from, std::int64_t count) const
  {
    this->order();
    this->HostMachine::beginToMachine(to, from, count);
  }
  template <class T> void copy(T* to, const T* from, std::int64_t count) const
  {
    this->order();
    this->HostMachine::copy(to, from, count);
  }
  template <class T> void fill(T* to, int byte, std::int64_t count) const
  {
    this->order();
    this->HostMachine::fill(to, byte, count);
  }
  void wait() const { this->order(); }
  void after(const HostMachine& /*other*/) const { this->order(); }
  bool isIdle() const
  {
    this->order();
    return this->HostMachine::isIdle();
  }
  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t items, std::int64_t sharedBytes = 0) const
  {
    this->order();
    ++this->Orders->kernels;
    this->HostMachine::run(kernel, items, sharedBytes);
  }

private:
  void order() const
  {
    if (this->Orders->orders++ >= this->Orders->failsAt) {
      throw inr::Error(inr::ErrorCode::Device, "the machine is lost");
    }
  }

  std::shared_ptr<FailingOrders> Orders;
};
