// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/CellBlock.h"
#include "Core/Render/Scene/Cropping.h"
#include "Core/Render/Scene/Projection.h"

#include <glm/vec3.hpp>

namespace inr {

class PreIntegratedLookup;

/// What the stages of ray marching share within a frame.
struct MarchSettings
{
  glm::dvec3 dims{1.0};   ///< voxels per axis
  double step = 0.5;      ///< t between samples of level 0
  double unitsPerT = 1.0; ///< opacity unit distances per unit of t
  bool adaptive = true;   ///< Frame::adaptiveSampling
  Projector projector;    ///< of values, where these are not composited
  bool crops = false;     ///< samples that `cropping` does not show are left out
  Cropping cropping;
  /// Of each of the finest macro-cells, where its samples come from; null: LevelOfDetail chooses.
  const CellSampling* cellSampling = nullptr;
  /// Null: a sample has the colour of its value; else of the values since the one before it.
  const PreIntegratedLookup* preIntegrated = nullptr;

  /// Whether samples are at the ends of what they stand for, as values at both ends are looked at.
  INR_HOST_DEVICE bool looksAtBothEnds() const
  {
    return this->projector.findsSurfaces() || this->preIntegrated != nullptr;
  }
};

/// Optical depth that needs no finer sampling.
constexpr double FaintDepth = 0.05;

/// log2 of how many samples of optical depth `depth` each may be taken at once: at most 4.
INR_HOST_DEVICE inline int FaintSamples(const MarchSettings& settings, double depth)
{
  const bool two = settings.adaptive && 2.0 * depth <= FaintDepth;
  const bool four = settings.adaptive && 4.0 * depth <= FaintDepth;
  return static_cast<int>(two) + static_cast<int>(four);
}

} // namespace inr
