// SPDX-License-Identifier: BSD-3-Clause
//
// A host as two machines beside each other.
#pragma once

#include "Testing/CUDA/HostMachine.h"

#include <functional>
#include <vector>

/// One that runs its kernels either at once or as late as it may: when another one waits for it.
class LateMachine : public HostMachine
{
public:
  explicit LateMachine(bool late, HostLaunch launch = {}) : HostMachine(launch), Late(late) {}

  template <class Kernel>
  void run(const Kernel& kernel, std::int64_t items, std::int64_t sharedBytes = 0)
  {
    this->Begun.push_back([=] { this->HostMachine::run(kernel, items, sharedBytes); });
    if (!this->Late) {
      this->finish();
    }
  }
  void after(LateMachine& other) const { other.finish(); }
  bool isIdle() const { return this->Begun.empty(); }

private:
  void finish()
  {
    for (const std::function<void()>& kernel : this->Begun) {
      kernel();
    }
    this->Begun.clear();
  }

  bool Late;
  std::vector<std::function<void()>> Begun;
};
