// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Acceleration/AcceleratedField.h"
#include "Core/Render/Acceleration/AcceleratedRenderer.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace inr {

/// A renderer's frames, as far as an accelerator draws them: until that fails. Then, within the
/// call, all is left to the CPU.
class AcceleratedFrames
{
public:
  /// `renderer` may be null: nothing is drawn then.
  AcceleratedFrames(std::shared_ptr<AcceleratedField> field,
                    std::shared_ptr<AcceleratedRenderer> renderer)
      : Field(std::move(field)), Device(std::move(renderer))
  {}

  /// Whether it draws such a frame, and has not failed.
  bool draws(const Frame& frame);
  /// See AcceleratedRenderer.
  void setColors(const Majorants& majorants, const ColorLookup& colors);

  /// A picture, or nothing where the accelerator has failed.
  std::optional<FrameStatistics> march(const MarchJob& job, const DrawCall& call);
  std::optional<TracedTiles> tracePaths(const PathRound& round, const WorkLimit& limit,
                                        const std::function<bool()>& keepGoing);

  /// Draws a frame into a picture of its size.
  using Draw = std::function<void(const Frame&, const PassOutput&)>;
  /// Kernels that nobody has seen at work on a device like this one are not to be trusted unseen:
  /// before the first picture of a kind a small one, like that of `frame` as far as levels of at
  /// least `scale` show it, is drawn by both. Gives the accelerator up where it draws another one.
  void prove(const Frame& frame, double scale, const Draw& accelerated, const Draw& cpu);

  std::int64_t bytes() const { return this->Device ? this->Device->bytes() : 0; }
  std::int64_t bricks() const { return this->Device ? this->Device->bricks() : 0; }

private:
  /// Whether call() has succeeded.
  bool succeeds(const std::function<void()>& call);

  std::shared_ptr<AcceleratedField> Field;
  std::shared_ptr<AcceleratedRenderer> Device;
  std::uint64_t Proven = 0; ///< kinds of pictures, a bit for each
  int Tries = 0;            ///< with rays that told nothing, of layers or of few pixels
};

} // namespace inr
