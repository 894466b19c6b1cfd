// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/MacroCells/Majorants.h"
#include "Core/Render/MacroCells/SeenSpans.h"
#include "Core/Render/Paths/PathTracing.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/Tiling.h"

#include <cstdint>
#include <vector>

namespace inr {

/// The mean of complete pictures, each of one sample per pixel.
class Accumulator
{
public:
  /// Forgets everything, for pictures of width x height pixels.
  void reset(int width, int height, int channels = 4);
  /// Throws Error(InvalidArgument) when the shape is another.
  void add(const Image& sample);

  /// Pictures added since the last reset.
  std::int64_t samples() const { return this->Count; }
  /// 0 before the first sample. `picture` is resized.
  void mean(Image& picture) const;

private:
  int Width = 0;
  int Height = 0;
  int Channels = 4;
  std::int64_t Count = 0;
  std::vector<double> Sums; ///< of floats: exact to far more samples than anyone waits for
};

/// A frame by path tracing: what is at random in it depends on (Frame::seed, Frame::frameIndex,
/// pixel) only, so that the picture is independent of tiles and threads.
class PathTracer
{
public:
  /// Of Frame::paths and Frame::lights. `levels` >= 1 are the cache levels that points are asked
  /// at, by Frame::levelOfDetailScale; 1 means native resolution everywhere. The references must
  /// outlive the tracer. The frame is a valid one: see RequireValid.
  PathTracer(const Frame& frame, const RayGeometry& geometry, const glm::i64vec3& dims,
             const Majorants& majorants, const ColorLookup& colors, int levels = 1);
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  /// Traces one path through each pixel of a tile and writes premultiplied RGBA into `rgba`, a
  /// picture of the frame's size; alpha is 1 where the path met the medium, 0 where it passed.
  /// `depth`, when given, receives the window-space depth where it did, else 0. Tiles may be traced
  /// from several threads, each with a sampler of its own.
  FrameStatistics trace(const Tile& tile, FieldSampler& sampler, Image& rgba,
                        Image* depth = nullptr) const;

  const Frame& frame() const { return this->Picture; }
  /// What its paths share.
  const PathScene& scene() const { return this->Scene; }

private:
  const Frame& Picture;
  std::vector<glm::dvec4> Planes; ///< of Inner
  InnerRays Inner;
  std::vector<PathLight> Lights;
  PathScene Scene;
  SeenSpans Seen;
};

} // namespace inr
