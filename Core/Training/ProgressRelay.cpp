// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/ProgressRelay.h"

#include <utility>

namespace inr {

bool ProgressRelay::operator()(const TrainingProgress& progress)
{
  if (std::this_thread::get_id() == this->Owner) {
    return this->ask(progress);
  }
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Latest = progress;
  return this->Running;
}

void ProgressRelay::tell()
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  const std::optional<TrainingProgress> latest = std::exchange(this->Latest, std::nullopt);
  lock.unlock();
  if (latest && !this->ask(*latest)) {
    this->stop();
  }
}

void ProgressRelay::stop()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Running = false;
}

bool ProgressRelay::ask(TrainingProgress progress)
{
  progress.fraction = this->Begin + (1.0 - this->Begin) * progress.fraction;
  return !this->Observer || this->Observer(progress);
}

} // namespace inr
