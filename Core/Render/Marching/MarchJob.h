// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Marching/MarchSettings.h"
#include "Core/Render/Marching/Shading.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/ColorTable.h"
#include "Core/Render/Scene/Frame.h"

namespace inr {

/// What marching a frame takes, beyond the volume. The references are for the call.
struct MarchJob
{
  const Frame& frame;
  const RayGeometry& geometry;
  const MarchSettings& settings; ///< `cellSampling`: of the cells of the majorants that were set
  const ColorLookup& colors;     ///< those that were set
  const Shading* shading;        ///< null: colours as the transfer function gives them
};

} // namespace inr
