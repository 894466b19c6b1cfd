// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CacheBudget.h"

#include <memory>

namespace inr {

/// Keeps the bricks of a field that nobody renders for now, for who does next, as long as this
/// lives: others take their memory as that of any bricks, least recently used first, and the budget
/// drops them as a whole when what they need at least becomes much of it.
class KeptBricks
{
public:
  explicit KeptBricks(std::shared_ptr<BrickStore> store);
  ~KeptBricks();
  KeptBricks(const KeptBricks&) = delete;
  KeptBricks& operator=(const KeptBricks&) = delete;

private:
  friend class CacheBudget;

  const std::shared_ptr<CacheBudget> Budget;
  std::shared_ptr<BrickStore> Store; ///< null when the budget has dropped it
};

} // namespace inr
