// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Requests.h"
#include "Core/Render/Bricks/BlockVisibility.h"
#include "Core/Render/Bricks/BrickRun.h"
#include "Core/Render/Bricks/OnMiss.h"
#include "Core/Render/Bricks/SampleShader.h"
#include "Core/Render/Bricks/SufficientBricks.h"
#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/MacroCells/SeenSpans.h"
#include "Core/Render/Marching/SampleWalker.h"
#include "Core/Render/Marching/StepTable.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/Frame.h"

#include <memory>

namespace inr {

/// What a frame's rays share when they read from the cache. All read-only. What is made for a frame
/// is kept for as long as some picture is drawn from it.
struct CachedScene
{
  const Frame& frame;
  const RayGeometry& geometry;
  const Majorants& majorants;
  const ColorLookup& colors;
  std::shared_ptr<const StepTable> steps;
  std::shared_ptr<const SufficientBricks> bricks; ///< of the cache, the only ones to look at
  const BrickKernel& kernel;
  BrickFormat format; ///< of the cache's bricks
  MarchSettings settings;
  const Shading* shading; ///< null: colours as the transfer function gives them
  std::shared_ptr<const BlockVisibility> blocks; ///< null: of all blocks samples are taken
  std::shared_ptr<const SeenSpans> seen;
};

} // namespace inr
