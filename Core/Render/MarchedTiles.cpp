// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MarchedTiles.h"

#include "Core/Render/TileLoop.h"
#include "Core/Render/Timer.h"

#include <algorithm>
#include <utility>

namespace inr {

MarchedTiles::MarchedTiles(int width, int height)
    : Tiles(width, height), Marched(static_cast<std::size_t>(this->Tiles.count()))
{}

bool MarchedTiles::isDue(const MarchedTile& tile, const SufficientBricks& bricks) const
{
  const auto hasCome = [&](const Request& request) {
    return bricks.find(request.key) != PageTable::Unmapped;
  };
  const auto anyHasCome = [&](const RequestList& list) {
    return std::any_of(list.entries().begin(), list.entries().end(), hasCome);
  };
  return !this->begun() || anyHasCome(tile.missed) || anyHasCome(tile.absent);
}

FrameStatistics MarchedTiles::march(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                                    const std::function<bool()>& keepGoing,
                                    const PassOutput& output, RequestRanking& requests)
{
  const Timer timer;
  ForEachTile(arena, this->Tiles.count(), keepGoing, [&](std::int64_t k) {
    MarchedTile& tile = this->Marched[static_cast<std::size_t>(k)];
    if (!this->isDue(tile, scene.bricks)) {
      tile.statistics.work = {};
      return;
    }
    CachedMarcher marcher(scene, onMiss);
    MarchTile(scene, marcher, this->Tiles.tile(k), keepGoing, output);
    tile = {marcher.statistics(), std::move(marcher.requests()), std::move(marcher.absent())};
  });
  FrameStatistics sum;
  for (const MarchedTile& tile : this->Marched) {
    sum.add(tile.statistics);
    requests.add(tile.missed);
  }
  if (!this->begun()) {
    this->WholeSeconds = timer.seconds();
  }
  sum.marchSeconds = this->WholeSeconds;
  return sum;
}

} // namespace inr
