// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/Tiles/WorkLimit.h"

#include <functional>

namespace inr {

/// Where a pass puts its pixels. `depth` may be null, and so may `samples`: two channels, how many
/// samples the pixel took and the mean of the levels that they came from, -1 where it took none.
struct PassOutput
{
  Image& rgba;
  Image* depth;
  Image* samples = nullptr;
};

/// One drawing of a frame: where it goes, how much is done for it, and whether it goes on. All of
/// it is there for the call only.
struct DrawCall
{
  const PassOutput& output;
  const WorkLimit& limit;
  const std::function<bool()>& keepGoing; ///< see Renderer::render
};

} // namespace inr
