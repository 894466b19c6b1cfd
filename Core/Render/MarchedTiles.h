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
  /// Marches those tiles that were not yet, and those that looked for a brick in vain that is there
  /// now; the others' pixels are in `output` already. What all of them miss is added to `requests`,
  /// in the order of the tiles. Of the whole picture, but for the work, which is that of this time.
  /// Throws Error(Cancelled) when `keepGoing` says so, see ForEachTile; tiles are then to be thrown
  /// away.
  FrameStatistics march(const CachedScene& scene, OnMiss onMiss, const Arena& arena,
                        const std::function<bool()>& keepGoing, const PassOutput& output,
                        RequestRanking& requests);

private:
  struct MarchedTile
  {
    FrameStatistics statistics{};
    RequestList missed{};
    RequestList absent{};
  };

  /// Whether marching it may show something else than it did. (Not where a coarser brick has come
  /// in once more, with more blocks: what was wished for in its place will.)
  bool isDue(const MarchedTile& tile, const SufficientBricks& bricks) const;

  Tiling Tiles;
  std::vector<MarchedTile> Marched;
  double WholeSeconds = 0; ///< that marching all tiles took; 0 before
};

} // namespace inr
