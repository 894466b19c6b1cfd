// SPDX-License-Identifier: BSD-3-Clause
//
// Rays that meet translucent layers: MarchRays, part by part of their ways. Apart from that, whose
// rays have neither memory nor registers to spare for what only these need.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Render/Kernels/FrameCounts.h"
#include "CUDA/Render/Kernels/RayMarch.h"
#include "CUDA/Render/Kernels/RayOrder.h"
#include "Core/Render/LayeredWay.h"

namespace inr {
namespace cuda {

/// Where such a ray stands, as long as it waits.
struct LayeredProgress
{
  RayProgress ray; ///< on the present part of its way
  LayeredWay layered;
};

struct MarchLayeredRays
{
  static constexpr int Threads = 128;
  static constexpr int LeastBlocks = 4; ///< they remember more than MarchRays'
  static constexpr int Turns[] = {RayLists::NoLimit};

  const RenderScene* scene;
  CacheView cache;
  RayLists lists;
  OnMiss onMiss;
  bool begin;                ///< else rays go on from where they are
  LayeredProgress* progress; ///< of each ray of the window
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
    const auto x = static_cast<int>(pixel % rays.width);
    const auto y = static_cast<int>(pixel / rays.width);
    LayeredProgress state;
    RayCounts counts;
    if (this->begin) {
      counts.rays = rays.ray(x, y).length > 0 ? 1 : 0;
    } else {
      state = this->progress[ray];
    }
    bool goesOn = true;
    while (goesOn) {
      const Ray way = rays.ray(x, y, state.layered.part);
      RayMarch march(*this->scene, this->cache, this->onMiss, way, x, y, state.ray);
      const bool ended = march.advance();
      counts.add(march.counts());
      if (!ended) {
        this->progress[ray] = state;
        this->lists.list(ray, true);
        break;
      }
      goesOn = this->enterNextPart(way, pixel, state);
      if (!goesOn) {
        this->write(pixel, state);
      }
    }
    this->counts->add(counts);
  }

  /// Of a ray that has come to the end of a part; false where that was the last one.
  INR_HOST_DEVICE bool enterNextPart(const Ray& way, std::int64_t pixel,
                                     LayeredProgress& state) const
  {
    const RayView& rays = this->scene->rays;
    const glm::dvec4 light = state.ray.light.sum();
    state.layered.noteHalfOpaque(rays, way, state.ray.halfOpaqueAt);
    state.ray.interval = RayProgress::NotBegun;
    return state.layered.enterNextPart(rays.layers, pixel, glm::vec3(light),
                                       static_cast<float>(light.w)) &&
           !state.ray.light.isOpaque();
  }

  INR_HOST_DEVICE void write(std::int64_t pixel, const LayeredProgress& state) const
  {
    const double through = state.ray.light.sum().w;
    const double depth = state.layered.halfOpaqueDepth;
    reinterpret_cast<glm::vec4*>(this->picture.rgba)[pixel] =
        glm::vec4(state.layered.light.seen(), static_cast<float>(1.0 - through));
    this->picture.depth[pixel] = depth >= 0 ? static_cast<float>(depth) : 1.0f;
    WriteSamples(state.ray, this->picture, pixel);
  }
};

} // namespace cuda
} // namespace inr
