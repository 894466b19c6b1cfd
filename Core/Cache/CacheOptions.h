// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CachePrecision.h"

#include <cstdint>

namespace inr {

/// How the cache is made and filled.
struct CacheOptions
{
  /// Of the whole cache; 0 = DefaultCacheBytes(). The caches of all renderers of a process stay
  /// within the largest of these. Renderers note 80 bytes more for each brick that they look at:
  /// which of its blocks their colours show, and whether these are known.
  std::int64_t bytes = 0;
  CachePrecision precision = CachePrecision::Bits16;
  int brickSize = 40;       ///< voxels per side, 4 to 1024
  int maximumRequests = 40; ///< bricks inferred between two looks at what is wanted; above 0
  bool ranking = true;      ///< what contributes most first; else in the order of the tiles
  bool preloading = true;   ///< level by level from coarse to fine; else the wanted level at once
  bool background = true;   ///< bricks for frames in a limited time come in between frames, too
  /// What the cache has no room for is shown from coarser levels, and a picture is complete when
  /// the cache is full; else it is inferred for the picture and dropped.
  bool onlyWhatFits = false;

  bool operator==(const CacheOptions& other) const
  {
    return this->bytes == other.bytes && this->precision == other.precision &&
           this->brickSize == other.brickSize && this->maximumRequests == other.maximumRequests &&
           this->ranking == other.ranking && this->preloading == other.preloading &&
           this->background == other.background && this->onlyWhatFits == other.onlyWhatFits;
  }
};

/// A quarter of UsableMemory(), which so many processes share; at most 16 GiB.
std::int64_t DefaultCacheBytes(int processes = 1);

} // namespace inr
