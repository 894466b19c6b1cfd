// SPDX-License-Identifier: BSD-3-Clause
//
// Rays that meet translucent layers, part by part of their ways, and those of which both ends of
// samples are looked at. Kernels of their own, so that MarchRays needs no more registers or memory
// for them.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Render/Kernels/EndsMarch.h"
#include "CUDA/Render/Kernels/FrameCounts.h"
#include "CUDA/Render/Kernels/RayMarch.h"
#include "CUDA/Render/Kernels/RayOrder.h"
#include "Core/Render/Rays/LayeredWay.h"

namespace inr {
namespace cuda {

/// Marches rays of kind `March` as MarchRays does its own, with or without layers.
template <class March> struct MarchInParts
{
  static constexpr int Threads = 128;
  static constexpr int LeastBlocks = 4; ///< more registers than for MarchRays
  static constexpr int Turns[] = {RayLists::NoLimit};

  /// Where such a ray stands, as long as it waits.
  struct Progress
  {
    typename March::Progress ray; ///< on the present part of its way
    LayeredWay layered;
  };

  const RenderScene* scene;
  CacheView cache;
  RayLists lists;
  OnMiss onMiss;
  bool begin;         ///< else rays go on from where they are
  Progress* progress; ///< of each ray of the window
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
    const RayView& rays = this->scene->rays;
    const int x = rays.column(pixel);
    const int y = rays.row(pixel);
    Progress state;
    RayCounts counts;
    bool goesOn = true;
    if (this->begin) {
      goesOn = rays.ray(x, y).length > 0;
      counts.rays = goesOn ? 1 : 0;
    } else {
      state = this->progress[ray];
    }
    bool waits = false;
    while (goesOn) {
      const Ray way = rays.ray(x, y, state.layered.part);
      March march(*this->scene, this->cache, this->onMiss, way, x, y, state.ray);
      waits = !march.advance();
      counts.add(march.counts());
      goesOn = !waits && this->enterNextPart(way, pixel, state);
    }
    if (waits) {
      this->progress[ray] = state;
      this->lists.list(ray, true);
    } else {
      this->write(pixel, state);
    }
    this->counts->add(counts);
  }

  /// Of a ray that has come to the end of a part; false where that was the last one.
  INR_HOST_DEVICE bool enterNextPart(const Ray& way, std::int64_t pixel, Progress& state) const
  {
    const glm::dvec4 light = state.ray.light.sum();
    March::beginPart(state.ray);
    return state.layered.enterNextPart(this->scene->rays, pixel, way, glm::vec3(light),
                                       static_cast<float>(light.w), state.ray.halfOpaqueAt);
  }

  INR_HOST_DEVICE void write(std::int64_t pixel, const Progress& state) const
  {
    const double through = state.ray.light.sum().w;
    const double depth = state.layered.halfOpaqueDepth;
    reinterpret_cast<glm::vec4*>(this->picture.rgba)[pixel] =
        glm::vec4(state.layered.light.seen(), static_cast<float>(1.0 - through));
    this->picture.depth[pixel] = depth >= 0 ? static_cast<float>(depth) : 1.0f;
    WriteSamples(state.ray, this->picture, pixel);
  }
};

using MarchLayeredRays = MarchInParts<RayMarch>;
using MarchBothEnds = MarchInParts<EndsMarch>;

} // namespace cuda
} // namespace inr
