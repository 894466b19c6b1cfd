// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/BlockVisibility.h"

#include <algorithm>

namespace inr {

static_assert(ShownBlocks::Words == BlockLattice::Most &&
              64 == BlockLattice::Most * BlockLattice::Most);

BlockVisibility::BlockVisibility(const BrickCache& cache, const ColorTable& colors)
    : Cache(cache), Colors(colors), Slots(cache.capacity())
{
  this->Slots.resize(cache.capacity());
}

void BlockVisibility::find(std::int32_t slot, ShownBlocks& shown) const
{
  Known& known = this->Slots[slot];
  const std::uint64_t arrival = this->Cache.arrival(slot);
  const std::uint64_t state = known.state.load(std::memory_order_acquire);
  if (state / 4 == arrival) {
    shown.kind = static_cast<ShownBlocks::Kind>(state % 4);
    for (int k = 0; shown.kind == ShownBlocks::Kind::Some && k < ShownBlocks::Words; ++k) {
      shown.words[k] = known.words[k].load(std::memory_order_relaxed);
    }
    return;
  }
  this->findOut(slot, shown);
  for (int k = 0; k < ShownBlocks::Words; ++k) { // whoever else is here stores the same
    known.words[k].store(shown.words[k], std::memory_order_relaxed);
  }
  known.state.store(4 * arrival + static_cast<std::uint64_t>(shown.kind),
                    std::memory_order_release);
}

void BlockVisibility::findOut(std::int32_t slot, ShownBlocks& shown) const
{
  const BrickBlocks& blocks = this->Cache.blocks();
  const glm::ivec3& count = blocks.lattice().count;
  ValueRange ranges[64 * ShownBlocks::Words];
  float extinctions[64 * ShownBlocks::Words];
  blocks.ranges(slot, ranges);
  this->Colors.maximumExtinctions(ranges, blocks.lattice().blocks(), extinctions);
  const BlockSet& known = blocks.known(slot);
  BlockSet visible;
  std::int64_t seen = 0;
  const float* extinction = extinctions;
  for (int z = 0; z < count.z; ++z) {
    for (int y = 0; y < count.y; ++y) {
      for (int x = 0; x < count.x; ++x) {
        if (*extinction++ > 0.0f && known.has({x, y, z})) {
          visible.add({x, y, z});
          ++seen;
        }
      }
    }
  }
  std::copy(visible.words.begin(), visible.words.end(), shown.words);
  shown.kind = seen == 0                           ? ShownBlocks::Kind::None
               : seen == blocks.lattice().blocks() ? ShownBlocks::Kind::All
                                                   : ShownBlocks::Kind::Some;
}

} // namespace inr
