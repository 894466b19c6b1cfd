// SPDX-License-Identifier: BSD-3-Clause
//
// What tests of Frame::errorTolerance share.
#pragma once

#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/FieldCells.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <cmath>

struct Drawn
{
  inr::Image picture;
  inr::FrameStatistics statistics;
};

/// To the end.
inline Drawn Draw(inr::Renderer& renderer, const inr::Frame& frame)
{
  Drawn drawn;
  drawn.statistics = renderer.render(frame, drawn.picture);
  EXPECT_TRUE(drawn.statistics.complete);
  return drawn;
}

inline const glm::i64vec3 FoggyDims(112, 96, 104);

/// Smooth nearly everywhere, with wires a voxel or two thick.
inline float FogAndWires(const glm::vec3& u)
{
  const float fog = 0.3f + 0.2f * std::sin(5 * u.x + 2 * u.z) * std::cos(4 * u.y);
  float wire = 0;
  for (const glm::vec2 at : {glm::vec2(0.3f, 0.4f), glm::vec2(0.7f, 0.6f)}) {
    const float x = 100 * (u.x - at.x - 0.05f * std::sin(6 * u.z));
    const float y = 100 * (u.y - at.y);
    wire = std::max(wire, std::exp(-0.7f * (x * x + y * y)));
  }
  return fog * (1 - wire) + wire;
}

inline inr::TransferFunction Glow()
{
  inr::TransferFunction function;
  function.table = {{0.1f, 0.2f, 1, 0.005f}, {0.2f, 0.6f, 0.8f, 0.02f}, {1, 0.3f, 0, 0.3f}};
  return function;
}

inline inr::Renderer MakeRenderer(std::int64_t cacheBytes = 64 << 20, int threads = 2,
                                  const inr::MacroCells& cells = CellsOf(FogAndWires, FoggyDims))
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cache.bytes = cacheBytes;
  options.cache.precision = inr::CachePrecision::Float32;
  options.cache.brickSize = 16;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(FogAndWires), VolumeOf(FoggyDims), cells,
                         options);
  renderer.setTransferFunction(Glow());
  return renderer;
}

inline inr::Frame FrameWith(std::optional<double> tolerance)
{
  inr::Frame frame = Oblique(glm::dvec3(FoggyDims), 72);
  frame.sampleDistance = 0.5;
  frame.unitDistance = 2;
  frame.errorTolerance = tolerance;
  return frame;
}
