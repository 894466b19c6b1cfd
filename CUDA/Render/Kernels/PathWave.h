// SPDX-License-Identifier: BSD-3-Clause
//
// Paths that ask the network itself for the field, by the stages of
// Core/Render/Paths/PathTracing.h.
#pragma once

#include "CUDA/Render/Kernels/PathPixel.h"
#include "CUDA/Render/Kernels/Wave.h"
#include "Core/Render/Paths/PathTracing.h"

#include <new>

namespace inr {
namespace cuda {

/// Such a path between two rounds.
struct WavePath
{
  INR_HOST_DEVICE WavePath(const PathScene& scene, int x, int y) : state(scene, x, y) {}

  PathState state;
  PathSample sample{}; ///< where it asks for the field
  FieldPoint point{};
  std::int64_t pixel = -1; ///< of the picture
  std::int64_t first = 0;  ///< its place among the round's points
};

struct PathStages
{
  using Ray = WavePath;
  static constexpr int MostPoints = 1;
  static constexpr int MostNeighbors = 0;

  const PathScene* scene;
  PictureView picture; ///< depth of first collisions, 0 where there was none; no samples

  INR_HOST_DEVICE void begin(int x, int y, WavePath& path) const
  {
    new (&path) WavePath(*this->scene, x, y);
  }
  INR_HOST_DEVICE bool meets(const WavePath& path) const { return path.state.ray.length > 0; }

  INR_HOST_DEVICE int place(WavePath& path) const
  {
    return PlaceSample(*this->scene, path.state, path.sample, path.point) ? 1 : 0;
  }
  INR_HOST_DEVICE int points(const WavePath&) const { return 1; }
  INR_HOST_DEVICE glm::vec3 position(const WavePath& path, int) const
  {
    return NetworkPosition(path.point, this->scene->dims);
  }

  INR_HOST_DEVICE bool isMarked(const WavePath& path, const WaveValues& values) const
  {
    return HasMarked(values.points + path.first, 1);
  }

  INR_HOST_DEVICE bool take(WavePath& path, const WaveValues& values, RayCounts& counts) const
  {
    float value = values.points[path.first];
    ++counts.samples;
    counts.clamped += ClampToRange(path.sample.range, value) ? 1 : 0;
    counts.lightSteps += path.state.towardsLight ? 1 : 0;
    return Collide(*this->scene, path.state, path.sample.majorant, value);
  }

  INR_HOST_DEVICE void write(const WavePath& path, std::int64_t pixel, RayCounts& counts) const
  {
    WritePath(*this->scene, path.state, this->picture, pixel);
    counts.scatterings += static_cast<std::uint32_t>(path.state.bounces);
  }
};

} // namespace cuda
} // namespace inr
