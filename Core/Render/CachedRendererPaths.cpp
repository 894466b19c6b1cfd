// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/CachedRenderer.h"
#include "Core/Render/Paths/CachedPaths.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/PassClock.h"
#include "Core/Render/Tiles/WorkLimit.h"

#include <algorithm>

namespace inr {

TracedTiles CachedRenderer::tracePaths(const PathRound& round, const Majorants& majorants,
                                       const ColorTable& colors, const WorkLimit& limit,
                                       const std::function<bool()>& keepGoing)
{
  this->Unfinished.forget(round.tracer.frame().view); // of its rays
  const bool hides = majorants.rangesHold() && colors.hidesAny();
  const SufficientBricks& bricks =
      *this->bricksFor(majorants, hides ? std::optional<int>(0) : std::nullopt);
  const bool contested = limit.isLimited() && this->Store->hasLostSince(this->Latest);
  this->Shortage.begin(round.first, !limit.isLimited(), contested);
  if (round.whole || this->Store->frame() != this->Latest) {
    this->beginFrame();
  }
  const OnPathMiss onMiss = this->onPathMiss(limit);
  // A picture that shows something everywhere can wait for the rest of another path. Before, it is
  // inferring that does: it takes many times as long as the round that said how long a round is.
  const bool hurries =
      limit.isTimed() && (!round.blank || (onMiss == OnPathMiss::Infer && !round.first));
  PassClock clock(limit, hurries);
  RequestRanking requests;
  TracedTiles traced = TraceThroughCache(round, {bricks, *this->Field, onMiss}, clock,
                                         this->Threads, keepGoing, requests);
  this->Shortage.check(requests.count(), this->room());
  if (this->Shortage.lacks() && this->Options.onlyWhatFits) {
    traced.final = true;
    return traced;
  }
  if (this->Shortage.lacks()) { // what was missed was inferred
    for (FrameStatistics& tile : traced.tiles) {
      tile.missed = 0;
    }
  }
  this->loadForPaths(onMiss == OnPathMiss::Approach ? this->inSteps(requests, this->room())
                                                    : requests,
                     !round.first, limit, keepGoing);
  return traced;
}

OnPathMiss CachedRenderer::onPathMiss(const WorkLimit& limit) const
{
  if (this->Shortage.lacks() && !this->Options.onlyWhatFits) {
    return OnPathMiss::Infer;
  }
  const bool steps = limit.isLimited() || this->Options.onlyWhatFits;
  return steps && this->Options.preloading ? OnPathMiss::Approach : OnPathMiss::UseCoarser;
}

void CachedRenderer::loadForPaths(const RequestRanking& requests, bool again,
                                  const WorkLimit& limit, const std::function<bool()>& keepGoing)
{
  const std::int64_t room = this->room();
  const bool some = limit.isLimited() || this->Shortage.lacks();
  const std::int64_t most = std::min(room, some ? this->Options.maximumRequests : room);
  // Paths see of new bricks only what they come upon in another round, which takes its time.
  this->loadForFrame(this->Bricks->wanted(requests.ranked(most, this->Options.ranking)), limit,
                     keepGoing, again ? 0.5 : 0.25);
  // What does not fit is not worth loading for one path: paths come back to it from everywhere.
  if (requests.count() > room) {
    this->Shortage.note();
  }
}

} // namespace inr
