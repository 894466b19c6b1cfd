// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/KeptBricks.h"

#include "Core/Cache/BrickStore.h"

#include <algorithm>
#include <utility>

namespace inr {

KeptBricks::KeptBricks(std::shared_ptr<BrickStore> store)
    : Budget(store->sharedBudget()), Store(std::move(store))
{
  const std::lock_guard<std::mutex> lock(this->Budget->Making);
  this->Budget->Kept.push_back(this);
}

KeptBricks::~KeptBricks()
{
  const std::lock_guard<std::mutex> lock(this->Budget->Making);
  std::vector<KeptBricks*>& kept = this->Budget->Kept;
  kept.erase(std::find(kept.begin(), kept.end(), this));
}

} // namespace inr
