// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MarchedTiles.h"

#include "Core/Render/Tiles/TileLoop.h"
#include "Core/Timer.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace inr {

namespace {

bool IsThere(const Request& request, const SufficientBricks& bricks)
{
  return bricks.find(request.key) != PageTable::Unmapped;
}

} // namespace

MarchedTiles::MarchedTiles(int width, int height)
    : Tiles(width, height), Marched(static_cast<std::size_t>(this->Tiles.count()))
{}

void MarchedTiles::MarchedTile::update(CachedMarcher& marcher)
{
  this->statistics = marcher.statistics();
  this->missed = std::move(marcher.requests());
  double sum = 0;
  for (const Request& request : this->missed.entries()) {
    sum += request.contribution;
  }
  this->mostMissed = std::max(this->mostMissed, sum);
  this->enough = std::max(sum / 2, this->mostMissed / 8);
}

bool MarchedTiles::MarchedTile::isDue(const SufficientBricks& bricks) const
{
  std::size_t come = 0;
  double sum = 0;
  for (const Request& request : this->missed.entries()) {
    if (IsThere(request, bricks)) {
      ++come;
      sum += request.contribution;
    }
  }
  return come > 0 && (come == this->missed.entries().size() || sum >= this->enough);
}

double MarchedTiles::secondsToMarch(const SufficientBricks& bricks) const
{
  const auto due = std::count_if(this->Marched.begin(), this->Marched.end(),
                                 [&](const MarchedTile& tile) { return tile.isDue(bricks); });
  return this->WholeSeconds * static_cast<double>(due) / static_cast<double>(this->Tiles.count());
}

FrameStatistics MarchedTiles::march(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                                    const std::function<bool()>& keepGoing,
                                    const PassOutput& output, RequestRanking& requests)
{
  const Timer timer;
  ForEachTile(arena, this->Tiles.count(), keepGoing, [&](std::int64_t k) {
    MarchedTile& tile = this->Marched[static_cast<std::size_t>(k)];
    if (this->begun() && !tile.isDue(scene.bricks)) {
      tile.statistics.work = {};
      return;
    }
    CachedMarcher marcher(scene, onMiss);
    MarchTile(scene, marcher, this->Tiles.tile(k), keepGoing, output);
    tile.update(marcher);
  });
  FrameStatistics sum;
  for (const MarchedTile& tile : this->Marched) {
    sum.add(tile.statistics);
    requests.add(tile.missed,
                 [&](const Request& request) { return !IsThere(request, scene.bricks); });
  }
  if (!this->begun()) {
    this->WholeSeconds = timer.seconds();
  }
  sum.marchSeconds = this->WholeSeconds;
  return sum;
}

} // namespace inr
