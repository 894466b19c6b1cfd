// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <mutex>
#include <optional>
#include <thread>

namespace inr {

/// An observer that may be called on any thread: what others say is told to the real one by the
/// thread that made this, since it is the one whose callbacks the host application expects.
class ProgressRelay
{
public:
  /// What is told is `begin` and the rest of 1 in proportion. `observer` must outlive this.
  ProgressRelay(const TrainingObserver& observer, double begin) : Observer(observer), Begin(begin)
  {}
  ProgressRelay(const ProgressRelay&) = delete;
  ProgressRelay& operator=(const ProgressRelay&) = delete;

  /// From any thread; false once the real observer, or stop(), has said so.
  bool operator()(const TrainingProgress& progress);

  /// On the thread that made this: hands on what was said last, if that is new.
  void tell();

  void stop();

private:
  bool ask(TrainingProgress progress);

  const TrainingObserver& Observer;
  double Begin;
  std::thread::id Owner = std::this_thread::get_id();
  std::mutex Mutex;
  std::optional<TrainingProgress> Latest; ///< that was not told yet
  bool Running = true;
};

} // namespace inr
