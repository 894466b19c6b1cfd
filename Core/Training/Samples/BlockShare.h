// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Samples/BatchSource.h"

#include <algorithm>
#include <cstdint>

namespace inr {

/// What one process of several takes of a volume's blocks, whose number is a power of two, and of
/// the items of a mini-batch that come out of them, in their order: as equal shares as there can
/// be.
struct BlockShare
{
  /// Of a process alone: all.
  explicit BlockShare(std::int64_t blocks, int rank = 0, int size = 1) : processes(size)
  {
    const std::int64_t units = std::min(blocks, BatchSize);
    const std::int64_t first = units * rank / size;
    const std::int64_t end = units * (rank + 1) / size;
    this->firstBlock = first * (blocks / units);
    this->endBlock = end * (blocks / units);
    this->firstItem = first * (BatchSize / units);
    this->endItem = end * (BatchSize / units);
    this->mostBlocks = (units + size - 1) / size * (blocks / units);
  }

  std::int64_t blocks() const { return this->endBlock - this->firstBlock; }
  std::int64_t items() const { return this->endItem - this->firstItem; }

  std::int64_t firstBlock;
  std::int64_t endBlock;
  std::int64_t firstItem;
  std::int64_t endItem;
  std::int64_t mostBlocks; ///< that a process takes
  int processes;
};

} // namespace inr
