// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Requests.h"
#include "Core/Render/Blending/CachedPasses.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/DrawCall.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace inr {

/// The tiles of a picture that is marched with what is in the cache, and once more when bricks have
/// come: each as it was last marched.
class MarchedTiles
{
public:
  /// Of which none has been marched. `over`: pixels that show the same already.
  MarchedTiles(int width, int height, bool over = false);

  /// When it was last marched, in the time of the store; nothing: it was not.
  std::optional<std::uint64_t> latestFrame;
  /// Whether bricks were asked for that they missed: some may show more by now, and what they have
  /// used before keeps its place in the cache.
  bool haveAsked = false;

  /// Whether all show something.
  bool areReached() const { return this->Over || this->Reached == this->Tiles.count(); }
  /// Whether none is to be marched by now.
  bool areUpToDate(const SufficientBricks& bricks) const { return this->due(bricks).empty(); }
  /// What marching those may take that are due by now, judged by the time that others took.
  double secondsToMarch(const SufficientBricks& bricks) const;
  /// Marches those tiles that were not yet, then those for which enough has come of what they
  /// missed, as many as PassClock lets begin; the others' pixels are in the output already or, of
  /// those that were never marched, show what they are over, or let everything through. What tiles
  /// still miss is added to `requests`, in the order of the tiles. Of the whole picture, but for
  /// the work, which is that of this time; complete where all is marched and nothing is missed.
  /// Throws Error(Cancelled) when the call's `keepGoing` says so, see ForEachTile; tiles are then
  /// to be thrown away.
  FrameStatistics march(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                        const DrawCall& call, RequestRanking& requests);

private:
  struct MarchedTile
  {
    /// Takes what `marcher` has counted and missed in it.
    void update(CachedMarcher& marcher);
    /// Whether enough has come of what it missed: all, or half, if that is an eighth of the most
    /// that it has ever missed; else it would be marched for less and less in the end.
    ///
    /// Were tiles marched whenever a brick comes, pictures of 256^3 to 1208^3 voxels, in pieces of
    /// 0.1 s, would take 1.1 to 2.4 times as long until they are complete, and mostly be further
    /// from it meanwhile. Were they marched only when all has come, it would be 0.8 to 1.0 times as
    /// long, and pictures up to 17 dB further from it in between.
    bool isDue(const SufficientBricks& bricks) const;

    int pass = 0; ///< in which it was last marched; 0: in none
    FrameStatistics statistics{};
    RequestList missed{};
    double mostMissed = 0; ///< contribution, of all times that it was marched
    double enough = 0;     ///< contribution that is to come
  };

  /// Those to march, in this order: which were marched longest ago come first.
  std::vector<std::int64_t> due(const SufficientBricks& bricks) const;
  /// Marches tiles that are due, and says of each whether there was time for it.
  std::vector<char> marchDue(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                             const DrawCall& call, const std::vector<std::int64_t>& due);
  /// That marching all tiles takes, judged by those that were reached; 0 before.
  double wholeSeconds() const;

  Tiling Tiles;
  bool Over;
  std::vector<MarchedTile> Marched;
  int Pass = 0;              ///< the latest
  std::int64_t Reached = 0;  ///< tiles that were ever marched
  double SecondsToReach = 0; ///< that these took, each the first time
};

} // namespace inr
