// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickPart.h"

#include <vector>

/// All blocks of some bricks.
inline std::vector<inr::BrickPart> Whole(const std::vector<inr::BrickKey>& keys)
{
  return {keys.begin(), keys.end()};
}
