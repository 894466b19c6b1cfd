// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/Frame.h"
#include "Representations/Mapper/Window/PictureGroup.h"

#include <cstdint>
#include <optional>

namespace inr {

/// The mapper's own properties.
struct PaintSettings
{
  RenderMode mode = RenderMode::RayMarching;
  PathOptions paths;
  int samplesPerPixel = 64;
  double sampleDistance = 0.5; ///< voxels; interactive pictures have twice that
  bool adaptiveSampling = true;
  bool preIntegration = false;
  double levelOfDetailScale = 1;
  std::optional<double> errorTolerance;
  bool countSamples = false;   ///< into PaintedFrame::samples
  double stillTimeLimit = -1;  ///< seconds; below 0: see vtkINRVolumeMapper
  int volumes = 1;             ///< that are drawn into the picture and share its time
  bool shownElsewhere = false; ///< see there
  bool forSelection = false;   ///< see there
  bool hurried = false;        ///< see there
  std::uint64_t seed = 0;
  RendererOptions renderer;
  PictureGroup group; ///< with whom to draw, see there
};

} // namespace inr
