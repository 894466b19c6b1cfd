// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Scene/ColorTable.h"

#include <atomic>
#include <cstdint>

namespace inr {

/// Which blocks of a cache's bricks show anything under some colours. Of a block that shows
/// nothing, all that is interpolated from its voxels is transparent. So it is when it is moved into
/// the range of its macro-cell, where that holds (Majorants::rangesHold): by no more than what the
/// cache rounds. Blocks that are not known count as showing nothing; SufficientBricks sees to it
/// that nobody looks at them. Found out brick by brick when first asked for, by any number of
/// threads.
class BlockVisibility
{
public:
  /// The references must outlive it. Takes 72 bytes for each slot that is asked for.
  BlockVisibility(const BrickCache& cache, const ColorTable& colors);

  /// Those of a mapped brick.
  void find(std::int32_t slot, ShownBlocks& shown) const;

private:
  struct Known
  {
    std::atomic<std::uint64_t> state; ///< 4 * the brick's arrival + the kind; 0: not yet known
    std::atomic<std::uint64_t> words[ShownBlocks::Words];
  };

  void findOut(std::int32_t slot, ShownBlocks& shown) const;

  const BrickCache& Cache;
  const ColorTable& Colors;
  ReservedArray<Known> Slots; ///< zeros, until somebody asks
};

} // namespace inr
