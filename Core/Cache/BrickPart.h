// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BlockSet.h"
#include "Core/Cache/BrickKey.h"

#include <functional>

namespace inr {

/// Some blocks of a brick, all of them unless something else is said.
struct BrickPart
{
  BrickPart(BrickKey key) : key(key) {} // NOLINT(google-explicit-constructor): it is that brick
  BrickPart(BrickKey key, const BlockSet& blocks) : key(key), blocks(blocks) {}

  BrickKey key;
  BlockSet blocks = BlockSet::all();
};

/// The blocks of a brick in which somebody looks at the field.
using WantedBlocks = std::function<BlockSet(BrickKey)>;

} // namespace inr
