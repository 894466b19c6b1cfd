// SPDX-License-Identifier: BSD-3-Clause
//
// The paths of a picture, a thread each, launch by launch, by the stages of
// Core/Render/Paths/PathTracing.h.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Render/Kernels/CachedField.h"
#include "CUDA/Render/Kernels/FrameCounts.h"
#include "CUDA/Render/Kernels/PathPixel.h"
#include "CUDA/Render/Kernels/RayOrder.h"
#include "Core/Render/Paths/PathTracing.h"

namespace inr {
namespace cuda {

/// Where a path stands between two launches.
struct PathProgress
{
  INR_HOST_DEVICE PathProgress(const PathScene& scene, int x, int y) : state(scene, x, y) {}

  PathState state;
  PathSample sample{}; ///< where it asks for the field next
  FieldPoint point{};
  bool asks = false; ///< whether it does
};

struct TracePaths
{
  static constexpr int Threads = 128;
  static constexpr int LeastBlocks = 5; ///< what one waits for, others have time for
  /// Few values of the field first, so that paths which end soon leave no idle threads behind, and
  /// then more and more.
  static constexpr int Turns[] = {32, 64, 128, 256, 1024, RayLists::NoLimit};

  const PathScene* scene;
  CacheView cache;
  RayLists lists;
  OnMiss onMiss;
  bool begin;             ///< else paths go on from where they are
  PathProgress* progress; ///< memory for one of each path of the window
  PictureView picture;    ///< depth of first collisions, 0 where there was none; no samples
  /// For each tile of the picture, of `tileEdge` pixels a side: values that came from coarser
  /// levels.
  std::uint32_t* tileMisses;
  int tileEdge;
  FrameCounts* counts;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    this->lists.forEach(block,
                        [&](std::uint32_t ray, std::int64_t pixel) { this->advance(ray, pixel); });
  }

private:
  INR_HOST_DEVICE void advance(std::uint32_t ray, std::int64_t pixel) const
  {
    const int width = this->scene->rays.width;
    const auto x = static_cast<int>(pixel % width);
    const auto y = static_cast<int>(pixel / width);
    // Its own copy: what is in the launch's memory is read and written one thread after another.
    PathProgress path = this->begin ? PathProgress(*this->scene, x, y) : this->progress[ray];
    RayCounts counts;
    bool ends = false;
    if (this->begin) {
      ends = !(path.state.ray.length > 0);
      counts.rays = ends ? 0 : 1;
    }
    CachedField field(this->cache, this->onMiss, counts);
    bool waits = false;
    while (!ends && !waits && static_cast<int>(counts.samples) < this->lists.most) {
      ends = !this->step(path, field, counts, waits);
    }
    if (ends) {
      this->write(path.state, pixel, counts);
    } else {
      this->progress[ray] = path;
      this->lists.list(ray, waits);
    }
    this->countMisses(x, y, counts.missed);
    this->counts->add(counts);
  }

  /// Asks for the field once; false when that ends the path.
  INR_HOST_DEVICE bool step(PathProgress& path, CachedField& field, RayCounts& counts,
                            bool& waits) const
  {
    if (!path.asks && !PlaceSample(*this->scene, path.state, path.sample, path.point)) {
      return false;
    }
    path.asks = true;
    float value = 0.0f;
    if (!field.find(path.point, value)) {
      waits = true;
      return true;
    }
    path.asks = false;
    counts.clamped += ClampToRange(path.sample.range, value) ? 1 : 0;
    counts.lightSteps += path.state.towardsLight ? 1 : 0;
    return Collide(*this->scene, path.state, path.sample.majorant, value);
  }

  INR_HOST_DEVICE void write(const PathState& path, std::int64_t pixel, RayCounts& counts) const
  {
    WritePath(*this->scene, path, this->picture, pixel);
    counts.scatterings += static_cast<std::uint32_t>(path.bounces);
  }

  INR_HOST_DEVICE void countMisses(int x, int y, std::uint32_t misses) const
  {
    if (misses > 0) {
      const int across = (this->scene->rays.width + this->tileEdge - 1) / this->tileEdge;
      AtomicAdd(this->tileMisses[y / this->tileEdge * across + x / this->tileEdge], misses);
    }
  }
};

} // namespace cuda
} // namespace inr
