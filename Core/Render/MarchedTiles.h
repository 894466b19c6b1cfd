// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Requests.h"
#include "Core/Render/Bricks/CachedPasses.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace inr {

/// The tiles of a picture that is marched with what is in the cache, and once more when bricks have
/// come: each as it was last marched.
class MarchedTiles
{
public:
  /// Of which none has been marched.
  MarchedTiles(int width, int height);

  bool begun() const { return this->WholeSeconds > 0; }
  /// What marching those may take that are due by now, judged by the time that all of them took.
  double secondsToMarch(const SufficientBricks& bricks) const;
  /// Marches those tiles that were not yet, and those for which enough has come of what they
  /// missed; the others' pixels are in `output` already. What all of them still miss is added to
  /// `requests`, in the order of the tiles. Of the whole picture, but for the work, which is that
  /// of this time. Throws Error(Cancelled) when `keepGoing` says so, see ForEachTile; tiles are
  /// then to be thrown away.
  FrameStatistics march(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                        const std::function<bool()>& keepGoing, const PassOutput& output,
                        RequestRanking& requests);

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

    FrameStatistics statistics{};
    RequestList missed{};
    double mostMissed = 0; ///< contribution, of all times that it was marched
    double enough = 0;     ///< contribution that is to come
  };

  Tiling Tiles;
  std::vector<MarchedTile> Marched;
  double WholeSeconds = 0; ///< that marching all tiles took; 0 before
};

} // namespace inr
