// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Contour/ContourBricks.h"

#include <cstdint>
#include <unordered_set>
#include <vector>

/// The bricks that one of several processes contours, in batches: first those that may hold some of
/// a surface by their ranges, then, where a surface turns out to leave those, the ones that it goes
/// on in.
class BrickQueue
{
public:
  /// Of the sorted `keys` the share of process `piece` of `pieces`.
  BrickQueue(const std::vector<inr::BrickKey>& keys, int piece, int pieces);

  /// The next bricks, at most `count`, in an order of their own; none when there are no more.
  std::vector<inr::BrickKey> Next(std::size_t count);

  /// The surface in `key` reaches the low or high face of an axis; see SurfacePatch::reaches.
  void Follow(inr::BrickKey key, const bool (&reaches)[6], const glm::i64vec3& bricks);

  /// Bricks known so far, and those handed out.
  std::int64_t GetNumberKnown() const { return static_cast<std::int64_t>(this->Waiting.size()); }
  std::int64_t GetNumberDone() const { return static_cast<std::int64_t>(this->Done); }

private:
  /// Every brick is one process's: that of the last selected one before it.
  bool IsMine(inr::BrickKey key) const { return key >= this->First && key < this->End; }

  inr::BrickKey First;
  inr::BrickKey End;
  std::vector<inr::BrickKey> Waiting; ///< from Done on
  std::size_t Done = 0;
  std::unordered_set<inr::BrickKey> Known;
};
