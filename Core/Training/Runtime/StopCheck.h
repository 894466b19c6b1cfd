// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <utility>

namespace inr {

/// Lets work in parallel be stopped from within. Only the thread that made it asks, since it is the
/// one whose callbacks the host application expects; the others learn what the answer was.
class StopCheck
{
public:
  /// `keepGoing` may throw; empty = never stop.
  explicit StopCheck(std::function<bool()> keepGoing = {}) : KeepGoing(std::move(keepGoing)) {}

  /// Between two blocks of work, from any thread. Once false it stays false.
  bool goesOn() const
  {
    if (this->KeepGoing && this->Running && std::this_thread::get_id() == this->Owner) {
      this->Running = this->KeepGoing();
    }
    return this->Running;
  }

private:
  std::function<bool()> KeepGoing;
  std::thread::id Owner = std::this_thread::get_id();
  mutable std::atomic<bool> Running{true};
};

} // namespace inr
