// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/Blending/CachedMarcher.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/DrawCall.h"
#include "Core/Render/Tiles/Tiling.h"

#include <functional>
#include <vector>

namespace inr {

class Arena;

/// How far a picture's rays have come, in samples, whether those were taken or left out.
std::int64_t CamePast(const FrameStatistics& statistics);

/// Marches a tile's rays to their ends, with a marcher that does not stop. Throws Error(Cancelled)
/// when `keepGoing` says so.
void MarchTile(const CachedScene& scene, CachedMarcher& marcher, const Tile& tile,
               const std::function<bool()>& keepGoing, const PassOutput& output);

/// What rays leave that have no samples: they let everything through.
void WriteEmpty(const Tile& tile, const PassOutput& output);

/// Marches the picture with every sample at the level it asks for, whatever the size of the cache:
/// tiles in a fixed order, as many at a time as their waiting rays fit memory; a ray that misses a
/// brick waits until the brick is there and goes on. A sample needs one brick, and one more for
/// each axis along which its gradient reaches into a neighbour.
class CompletePass
{
public:
  explicit CompletePass(const CachedScene& scene) : Scene(scene), Tiles(Size(scene)) {}

  /// One round: marches every ray at hand as far as it comes and writes finished pixels. The bricks
  /// that rays wait for come out of `requests`, in the order of their tiles. The round's work.
  WorkDone advance(const Arena& arena, const std::function<bool()>& keepGoing,
                   const PassOutput& output, RequestRanking& requests);
  /// Says that only `loaded` of the latest requests fitted, for the rest of the cache holds what
  /// rays that wait have used. Few: fewer tiles go on. None: the first ray does, alone until it has
  /// come further; the last request is then for its next sample.
  void crowd(std::int64_t loaded);
  const CachedScene& scene() const { return this->Scene; }
  bool isAlone() const { return this->Alone; }
  bool done() const { return this->Active.empty() && this->Next == this->Tiles.count(); }
  const FrameStatistics& statistics() const { return this->Statistics; }

private:
  struct WaitingRay
  {
    int x, y;
    CachedRay ray;
  };
  struct ActiveTile
  {
    std::int64_t tile;
    bool started = false;
    std::vector<WaitingRay> waiting;
  };

  struct TileNotes ///< of a round
  {
    FrameStatistics statistics;
    RequestList requests;
  };

  static Tiling Size(const CachedScene& scene) { return {scene.frame.width, scene.frame.height}; }
  /// The first tiles at hand, one to each of `notes`.
  void marchTiles(const Arena& arena, const std::function<bool()>& keepGoing,
                  const PassOutput& output, std::vector<TileNotes>& notes);
  void start(ActiveTile& tile, CachedMarcher& marcher, const PassOutput& output) const;
  void resume(ActiveTile& tile, CachedMarcher& marcher, const PassOutput& output) const;

  const CachedScene& Scene;
  Tiling Tiles;
  std::int64_t Next = 0; ///< first tile that was not yet at hand
  std::vector<ActiveTile> Active;
  FrameStatistics Statistics;
  /// Tiles at work at once: some forty megabytes of waiting rays at most.
  std::size_t Window = 192;
  bool Alone = false; ///< only the first ray goes on
};

} // namespace inr
