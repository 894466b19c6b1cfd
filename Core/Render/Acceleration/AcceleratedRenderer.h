// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Marching/MarchJob.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/DrawCall.h"

#include <cstdint>
#include <functional>

namespace inr {

/// Draws frames of a model through a cache of its own or straight from the network, in the CPU's
/// place: an accelerator's, on which cache, rays and paths stay. For one renderer, and one call at
/// a time.
///
/// Pictures are those of the CPU but for rounding, and for what is missing in pictures that a time
/// limit cuts short. All throw Error(Device) where the accelerator fails, or has no memory; it is
/// of no use any more then.
class AcceleratedRenderer
{
public:
  virtual ~AcceleratedRenderer() = default;

  /// Whether it draws such a frame; others are the CPU's.
  virtual bool draws(const Frame& frame) const = 0;
  /// Copies what follows is drawn with. `majorants` are of `colors` and how frames are blended.
  virtual void setColors(const Majorants& majorants, const ColorLookup& colors) = 0;

  /// As Renderer::render, of frames that it draws.
  virtual FrameStatistics march(const MarchJob& job, const DrawCall& call) = 0;
  /// See TraceTiles.
  virtual TracedTiles tracePaths(const PathRound& round, const WorkLimit& limit,
                                 const std::function<bool()>& keepGoing) = 0;

  /// Of the accelerator's memory, by its cache, and bricks in there; 0 without one.
  virtual std::int64_t bytes() const = 0;
  virtual std::int64_t bricks() const = 0;
};

} // namespace inr
