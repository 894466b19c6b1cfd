// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Requests.h"
#include "Core/Render/CachedPasses.h"

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
    /// It was marched once more.
    void update(CachedMarcher& marcher);
    /// Whether enough has come of what it missed: half, and no less than an eighth of the most that
    /// it has ever missed; or all. Marched whenever a brick comes, pictures of 256^3 to 1208^3
    /// voxels, in pieces of 0.1 s, took 1.1 to 2.4 times as long until they were complete, and were
    /// no nearer to that meanwhile; only when all has come, they take 0.8 to 1.0 times as long, and
    /// are up to 17 dB further from it in between.
    bool isDue(const SufficientBricks& bricks) const;

    FrameStatistics statistics{};
    RequestList missed{};
    double most = 0;   ///< contribution of what it missed, of all times that it was marched
    double enough = 0; ///< of what it misses now
  };

  Tiling Tiles;
  std::vector<MarchedTile> Marched;
  double WholeSeconds = 0; ///< that marching all tiles took; 0 before
};

} // namespace inr
