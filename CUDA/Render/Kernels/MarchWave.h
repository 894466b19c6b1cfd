// SPDX-License-Identifier: BSD-3-Clause
//
// Rays that are marched straight through the network, by the stages of
// Core/Render/Marching/RayMarching.h; Core's TileMarcher does the same tile by tile.
#pragma once

#include "CUDA/Render/Kernels/RenderScene.h"
#include "CUDA/Render/Kernels/Wave.h"
#include "Core/Render/Marching/RayMarching.h"

#include <new>

namespace inr {
namespace cuda {

/// Such a ray between two rounds.
struct WaveRay
{
  MarchState state;
  MarchSample samples[SamplesPerRound];
  int count = 0;           ///< of samples
  std::uint32_t seen = 0;  ///< a bit for each of them that has a gradient
  std::int64_t pixel = -1; ///< of the picture
  std::int64_t first = 0;  ///< of the samples, among the round's points
  std::int64_t firstNeighbor = 0;
};

struct MarchStages
{
  using Ray = WaveRay;
  static constexpr int MostPoints = SamplesPerRound;
  static constexpr int PerGradient = 6;
  static constexpr int MostNeighbors = PerGradient * SamplesPerRound;

  const RenderScene* scene;
  PictureView picture; ///< no samples

  INR_HOST_DEVICE void begin(int x, int y, WaveRay& ray) const
  {
    const inr::Ray way = this->scene->rays.ray(x, y, 0);
    new (&ray) WaveRay{{way, this->samplesOf(way, x, y)}, {}};
  }

  INR_HOST_DEVICE bool meets(const WaveRay& ray) const
  {
    const RayView& rays = this->scene->rays;
    return ray.state.ray.length > 0 ||
           (rays.layers.any() && rays.ray(rays.column(ray.pixel), rays.row(ray.pixel)).length > 0);
  }

  INR_HOST_DEVICE int place(WaveRay& ray) const
  {
    ray.seen = 0;
    MarchState state = ray.state; // of which much changes often
    do {
      ray.count = PlaceSamples(this->scene->settings, state, SamplesPerRound, ray.samples);
    } while (ray.count == 0 && this->enterNextPart(ray, state));
    ray.state = state;
    return ray.count;
  }
  INR_HOST_DEVICE int points(const WaveRay& ray) const { return ray.count; }
  INR_HOST_DEVICE glm::vec3 position(const WaveRay& ray, int k) const
  {
    return ray.samples[k].position;
  }

  INR_HOST_DEVICE bool isMarked(const WaveRay& ray, const WaveValues& values) const
  {
    return HasMarked(values.points + ray.first, ray.count) ||
           HasMarked(values.neighbors + ray.firstNeighbor, NeighborsOf(ray));
  }

  INR_HOST_DEVICE bool take(WaveRay& ray, const WaveValues& values, RayCounts& counts) const
  {
    counts.samples += static_cast<std::uint32_t>(ray.count + NeighborsOf(ray));
    counts.gradients += static_cast<std::uint32_t>(NeighborsOf(ray) / PerGradient);
    const bool goesOn = this->scene->settings.projector.projects()
                            ? this->project(ray, values.points + ray.first, counts)
                            : this->composite(ray, values, counts);
    // Fewer are the last ones of a ray, or of a part of its way.
    return goesOn && (ray.count == SamplesPerRound || this->scene->rays.layers.any());
  }

  INR_HOST_DEVICE void write(const WaveRay& ray, std::int64_t pixel, RayCounts&) const
  {
    const MarchState& state = ray.state;
    const Projector& projector = this->scene->settings.projector;
    reinterpret_cast<glm::vec4*>(this->picture.rgba)[pixel] =
        ShownColor(state, projector, this->scene->colors, this->scene->rays);
    this->picture.depth[pixel] =
        static_cast<float>(ShownDepth(state, projector, this->scene->colors, this->scene->rays));
  }

  /// Of those samples of which something is seen; those behind which a ray is opaque are the last.
  INR_HOST_DEVICE int findNeighbors(WaveRay& ray, const WaveValues& values) const
  {
    const float* const found = values.points + ray.first;
    ray.seen = 0;
    if (HasMarked(found, ray.count)) { // it is not known of which
      return 0;
    }
    double opacity = ray.state.color.w;
    for (int k = 0; k < ray.count && opacity < OpaqueEnough; ++k) {
      float value = found[k];
      ClampToRange(ray.samples[k].range, value); // counted when it is composited
      const float alpha = this->scene->colors.at(value).w;
      if (alpha > 0.0f) {
        ray.seen |= 1u << k;
        opacity += (1.0 - opacity) * OpacityOver(ray.samples[k].length, alpha);
      }
    }
    return NeighborsOf(ray);
  }

  /// Below and above each such sample along x, y and z.
  INR_HOST_DEVICE void listNeighbors(const WaveRay& ray, float* positions) const
  {
    for (int k = 0; k < ray.count; ++k) {
      if ((ray.seen >> k & 1u) == 0) {
        continue;
      }
      for (int side = 0; side < PerGradient; ++side) {
        const glm::vec3 position = this->neighbor(ray.samples[k], side);
        for (int axis = 0; axis < 3; ++axis) {
          *positions++ = position[axis];
        }
      }
    }
  }

private:
  INR_HOST_DEVICE SampleWalker samplesOf(const inr::Ray& way, int x, int y) const
  {
    const MarchSettings& settings = this->scene->settings;
    return {this->scene->majorants,
            settings,
            way,
            0,
            1,
            JitterOf(settings, this->scene->streams.at(x, y))};
  }

  /// Sends a ray on behind the next translucent layer; false when there is no more to see.
  INR_HOST_DEVICE bool enterNextPart(const WaveRay& ray, MarchState& state) const
  {
    const RayView& rays = this->scene->rays;
    const int x = rays.column(ray.pixel);
    const int y = rays.row(ray.pixel);
    if (!rays.layers.any() || !EnterNextPart(rays, x, y, state)) {
      return false;
    }
    state.samples = this->samplesOf(state.ray, x, y);
    return true;
  }

  INR_HOST_DEVICE static int NeighborsOf(const WaveRay& ray)
  {
    int count = 0;
    for (std::uint32_t rest = ray.seen; rest != 0; rest &= rest - 1) {
      count += PerGradient;
    }
    return count;
  }

  INR_HOST_DEVICE glm::vec3 neighbor(const MarchSample& sample, int side) const
  {
    const glm::vec3 voxel(1.0 / this->scene->settings.dims);
    const int axis = side / 2;
    const float low = 0.5f * voxel[axis];
    glm::vec3 position = sample.position;
    const float there = position[axis] + (side % 2 == 0 ? -1.0f : 1.0f) * voxel[axis];
    position[axis] = glm::clamp(there, low, 1.0f - low);
    return position;
  }

  INR_HOST_DEVICE bool composite(WaveRay& ray, const WaveValues& values, RayCounts& counts) const
  {
    const float* const found = values.points + ray.first;
    const float* around = values.neighbors + ray.firstNeighbor;
    for (int k = 0; k < ray.count && ray.state.color.w < OpaqueEnough; ++k) {
      float value = found[k];
      counts.clamped += ClampToRange(ray.samples[k].range, value) ? 1 : 0;
      glm::vec4 color = this->scene->colors.at(value);
      if ((ray.seen >> k & 1u) != 0) {
        this->shade(ray.state.ray, ray.samples[k], around, color);
        around += PerGradient;
      }
      Composite(color, ray.samples[k], ray.state);
    }
    return ray.state.color.w < OpaqueEnough;
  }

  INR_HOST_DEVICE void shade(const inr::Ray& way, const MarchSample& sample, const float* around,
                             glm::vec4& color) const
  {
    glm::vec3 gradient(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      const float distance =
          this->neighbor(sample, 2 * axis + 1)[axis] - this->neighbor(sample, 2 * axis)[axis];
      const float length = distance * static_cast<float>(this->scene->settings.dims[axis]);
      const float difference = around[2 * axis + 1] - around[2 * axis];
      gradient[axis] = length > 0.0f ? difference / length : 0.0f;
    }
    const ShadingView& lighting = this->scene->shading;
    color = glm::vec4(
        lighting.shade(glm::vec3(color), lighting.toEye(way), way.at(sample.t), gradient), color.w);
  }

  INR_HOST_DEVICE bool project(WaveRay& ray, const float* found, RayCounts& counts) const
  {
    const Projector& projector = this->scene->settings.projector;
    for (int k = 0; k < ray.count; ++k) {
      const MarchSample& sample = ray.samples[k];
      float value = found[k];
      counts.clamped += ClampToRange(sample.range, value) ? 1 : 0;
      projector.add(this->scene->colors, value, static_cast<double>(sample.length),
                    static_cast<double>(sample.t), ray.state.projection);
    }
    return !projector.isFinal(ray.state.projection);
  }
};

} // namespace cuda
} // namespace inr
