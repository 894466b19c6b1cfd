// SPDX-License-Identifier: BSD-3-Clause
//
// A small scene for path tracing through the Renderer.
#pragma once

#include "Testing/Core/Render/PathScene.h"

#include <memory>

inline const glm::i64vec3 Dims(33, 33, 33);

/// Linear along every axis, so that interpolation between voxels has no error.
inline float Multilinear(const glm::vec3& u)
{
  return 0.1f + 0.8f * u.x * u.y + 0.1f * u.z - 0.3f * u.x * u.y * u.z;
}

inline inr::TransferFunction Medium()
{
  inr::TransferFunction medium;
  medium.table = {{1, 0.2f, 0, 0}, {0.3f, 1, 0, 0.05f}, {0.1f, 0.5f, 1, 0.3f}};
  return medium;
}

inline inr::CacheOptions SmallBricks()
{
  inr::CacheOptions cache;
  cache.precision = inr::CachePrecision::Float32;
  cache.brickSize = 8;
  cache.bytes = 64 << 20;
  cache.background = false; // every call brings something
  return cache;
}

inline inr::Renderer MakeRenderer(bool cached, int threads = 2,
                                  const inr::CacheOptions& cache = SmallBricks())
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cached = cached;
  options.cache = cache;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(Multilinear), VolumeOf(Dims), {},
                         options);
  renderer.setTransferFunction(Medium());
  return renderer;
}

/// Everything at once: oblique, ambient light and a lamp, some rays past the volume.
inline inr::Frame LitFrame(int size = 24)
{
  inr::Frame frame = ParallelFrame(size, {-4, -4}, {36, 36}, -30, 80);
  frame.clipToWorld = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0, 1, 0.2)) * frame.clipToWorld;
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 4;
  frame.levelOfDetailScale = 0;
  frame.paths.ambientLight = {0.2f, 0.3f, 0.4f};
  frame.paths.anisotropy = 0.3;
  frame.lights = {inr::Light{}};
  frame.lights[0].color = {2, 1, 1};
  return frame;
}
