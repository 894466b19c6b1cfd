// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/DrawnFrame.h"

namespace inr {

namespace {

/// What paths do not depend on: they have no samples at given distances, and light of their own.
void ForPaths(Frame& frame)
{
  frame.sampleDistance = Frame().sampleDistance;
  frame.shading.reset();
}

void ForRays(Frame& frame)
{
  const BlendMode mode = frame.blending.mode;
  frame.paths = {};
  if (frame.blending.projects()) {
    frame.shading.reset();
  }
  if (!frame.shading) {
    frame.lights.clear();
  }
  if (mode == BlendMode::MaximumIntensity || mode == BlendMode::MinimumIntensity ||
      mode == BlendMode::AverageIntensity ||
      mode == BlendMode::Isosurface) { // of single values, whose opacity is for no length
    frame.unitDistance = Frame().unitDistance;
  }
}

} // namespace

Frame AsItIsDrawn(Frame frame, bool cached)
{
  const bool traces = frame.mode == RenderMode::PathTracing;
  traces ? ForPaths(frame) : ForRays(frame);
  const bool addsUp = !traces && frame.blending.mode == BlendMode::Composite;
  frame.preIntegration = frame.preIntegration && addsUp;
  frame.adaptiveSampling = frame.adaptiveSampling && addsUp;
  if (!cached) { // there is but the full resolution
    frame.levelOfDetailScale = 0;
    frame.errorTolerance.reset();
  } else if (frame.errorTolerance) { // that chooses levels and distances of samples
    frame.levelOfDetailScale = 0;
    frame.adaptiveSampling = false;
    frame.preIntegration = false;
  }
  return frame;
}

} // namespace inr
