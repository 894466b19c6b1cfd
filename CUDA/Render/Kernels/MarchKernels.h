// SPDX-License-Identifier: BSD-3-Clause
//
// The rays of a picture, a thread each: those that have ended are written, and those that wait for
// bricks are listed for the launch that has them.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Render/Kernels/FrameCounts.h"
#include "CUDA/Render/Kernels/RayMarch.h"
#include "CUDA/Render/Kernels/RayOrder.h"

namespace inr {
namespace cuda {

struct MarchRays
{
  using Progress = RayProgress;

  static constexpr int Threads = 128;
  static constexpr int LeastBlocks = 5; ///< what one waits for, others have time for
  /// A single one: threads whose rays have ended cost less than to part those that were neighbours,
  /// which meet the same bricks at the same time.
  static constexpr int Turns[] = {RayLists::NoLimit};

  const RenderScene* scene;
  CacheView cache;
  RayLists lists;
  OnMiss onMiss;
  bool begin;            ///< else rays go on from where they are
  RayProgress* progress; ///< of each ray of the window
  PictureView picture;
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
    RayProgress state;
    if (!this->begin) {
      state = this->progress[ray];
    }
    const Ray way = this->scene->rays.ray(x, y);
    const bool begins = this->begin && way.length > 0;
    RayMarch march(*this->scene, this->cache, this->onMiss, way, x, y, state);
    if (march.advance()) {
      march.write(this->picture, pixel);
    } else {
      this->progress[ray] = state;
      this->lists.list(ray, true);
    }
    RayCounts counts = march.counts();
    counts.rays = begins ? 1 : 0;
    this->counts->add(counts);
  }
};

} // namespace cuda
} // namespace inr
