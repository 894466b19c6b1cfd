// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/BrickWay.h"

namespace inr {

/// What kernels need to know about the bricks of a cache.
BrickFormat FormatOf(const BrickCache& cache);

/// Samples of one ray that fall into one brick. Places on the ray count steps of `t`.
class BrickRun
{
public:
  /// Whether a sample of `level` at a place belongs here.
  bool covers(int level, double place) const
  {
    return level == this->Level && place >= this->Enter && place < this->Exit;
  }
  /// An empty run of samples that want the brick at which `wanted` is and are read from that at
  /// which `served` is, the same or one of a coarser level, which is mapped and in `view`. `step`
  /// is the t between places.
  void open(const BrickWay& wanted, const BrickWay& served, const BrickView& view, double step);
  /// Which blocks of the brick may be seen: all, unless something else is said.
  const ShownBlocks& shown() const { return this->Shown; }
  ShownBlocks& shown() { return this->Shown; }
  void close()
  {
    this->Level = -1;
    this->Count = 0;
  }

  double exit() const { return this->Exit; }
  /// Place where `path()` begins, a whole number.
  double reference() const { return this->Reference; }
  /// Steps along `path()` at a place that is a whole number.
  float along(double place) const { return static_cast<float>(place - this->Reference); }
  void count(int samples) { this->Count += samples; }

  const BrickPath& path() const { return this->Path; }
  /// The path's number in the batch being filled, -1 where it is not in there yet.
  int place() const { return this->Place; }
  void setPlace(int place) { this->Place = place; }

  int level() const { return this->Level; }
  bool exact() const { return this->ServedLevel == this->Level; } ///< served == wanted
  int servedLevel() const { return this->ServedLevel; }
  BrickKey served() const { return this->Served; }
  /// The brick to load, which is the wanted one unless said otherwise.
  BrickKey wish() const { return this->Wish; }
  void wishFor(BrickKey brick) { this->Wish = brick; }
  int count() const { return this->Count; } ///< samples so far

private:
  int Level = -1;
  double Enter = 0; ///< places
  double Exit = 0;
  double Reference = 0; ///< place of the path's origin, a whole number
  BrickPath Path{};
  int Place = -1;
  ShownBlocks Shown;
  int ServedLevel = -1;
  BrickKey Served = 0;
  BrickKey Wish = 0;
  int Count = 0;
};

} // namespace inr
