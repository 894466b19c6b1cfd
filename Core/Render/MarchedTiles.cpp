// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MarchedTiles.h"

#include "Core/Render/Tiles/PassClock.h"
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

MarchedTiles::MarchedTiles(int width, int height, bool over)
    : Tiles(width, height), Over(over), Marched(static_cast<std::size_t>(this->Tiles.count()))
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
  if (this->pass == 0) {
    return true;
  }
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

double MarchedTiles::wholeSeconds() const
{
  const auto reached = static_cast<double>(std::max<std::int64_t>(this->Reached, 1));
  return this->SecondsToReach * static_cast<double>(this->Tiles.count()) / reached;
}

double MarchedTiles::secondsToMarch(const SufficientBricks& bricks) const
{
  const auto due = static_cast<double>(this->due(bricks).size());
  return this->wholeSeconds() * due / static_cast<double>(this->Tiles.count());
}

std::vector<std::int64_t> MarchedTiles::due(const SufficientBricks& bricks) const
{
  std::vector<std::int64_t> due;
  for (std::int64_t k = 0; k < this->Tiles.count(); ++k) {
    if (this->Marched[static_cast<std::size_t>(k)].isDue(bricks)) {
      due.push_back(k);
    }
  }
  std::stable_sort(due.begin(), due.end(), [this](std::int64_t a, std::int64_t b) {
    return this->Marched[static_cast<std::size_t>(a)].pass <
           this->Marched[static_cast<std::size_t>(b)].pass;
  });
  return due;
}

std::vector<char> MarchedTiles::marchDue(const CachedScene& scene, OnMiss onMiss,
                                         const Arena& arena, const DrawCall& call,
                                         const std::vector<std::int64_t>& due)
{
  PassClock clock(call.limit, false);
  std::vector<char> marched(due.size());
  ForEachTile(arena, static_cast<std::int64_t>(due.size()), call.keepGoing, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    MarchedTile& tile = this->Marched[static_cast<std::size_t>(due[k])];
    if (clock.mayBegin()) {
      CachedMarcher marcher(scene, onMiss);
      MarchTile(scene, marcher, this->Tiles.tile(due[k]), call.keepGoing, call.output);
      tile.update(marcher);
      marched[k] = 1;
    } else if (tile.pass == 0 && !this->Over) {
      WriteEmpty(this->Tiles.tile(due[k]), call.output);
    }
  });
  return marched;
}

FrameStatistics MarchedTiles::march(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                                    const DrawCall& call, RequestRanking& requests)
{
  const Timer timer;
  const std::vector<std::int64_t> due = this->due(*scene.bricks);
  const std::vector<char> marched = this->marchDue(scene, onMiss, arena, call, due);
  ++this->Pass;
  FrameStatistics sum;
  std::int64_t count = 0;
  std::int64_t reached = 0;
  for (std::size_t k = 0; k < due.size(); ++k) {
    MarchedTile& tile = this->Marched[static_cast<std::size_t>(due[k])];
    if (marched[k] != 0) {
      ++count;
      reached += tile.pass == 0 ? 1 : 0;
      tile.pass = this->Pass;
      sum.work.add(std::exchange(tile.statistics.work, {})); // of this time
    }
  }
  for (const MarchedTile& tile : this->Marched) {
    sum.add(tile.statistics);
    requests.add(tile.missed,
                 [&](const Request& request) { return !IsThere(request, *scene.bricks); });
  }
  if (reached > 0) {
    this->Reached += reached;
    this->SecondsToReach +=
        timer.seconds() * static_cast<double>(reached) / static_cast<double>(count);
  }
  sum.blank = !this->areReached();
  sum.complete = count == static_cast<std::int64_t>(due.size()) && requests.empty();
  sum.marchSeconds = this->wholeSeconds();
  return sum;
}

} // namespace inr
