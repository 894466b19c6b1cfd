// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BlockSet.h"
#include "Core/Cache/BrickKey.h"

namespace inr {

/// Some blocks of a brick, all of them unless something else is said.
struct BrickPart
{
  BrickPart(BrickKey key) : key(key) {} // NOLINT(google-explicit-constructor): it is that brick
  BrickPart(BrickKey key, const BlockSet& blocks) : key(key), blocks(blocks) {}

  BrickKey key;
  BlockSet blocks = BlockSet::all();
};

} // namespace inr
