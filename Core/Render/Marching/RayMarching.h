// SPDX-License-Identifier: BSD-3-Clause
//
// The stages of ray marching, as functions over one ray; a tile runs each over its live rays.
#pragma once

#include "Core/HostDevice.h"
#include "Core/Random.h"
#include "Core/Render/Marching/SampleWalker.h"
#include "Core/Render/Rays/LayeredWay.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/Opacity.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>

namespace inr {

/// Where a ray stands.
struct MarchState
{
  Ray ray;
  SampleWalker samples;
  glm::dvec4 color{0};      ///< premultiplied, so far: of any number of samples
  double halfOpaqueAt = -1; ///< t where opacity reached one half; -1 = not yet
  Projection projection{};  ///< instead, of values that are projected
  LayeredWay layered{};
  double knownAt = -1; ///< t where the value is known, where both ends of samples are looked at
  float known = 0;
};

/// The random streams of a frame's pixels. Plain data.
struct PixelStreams
{
  std::uint64_t seed;
  std::uint64_t width; ///< pixels

  /// Of the ray through one.
  INR_HOST_DEVICE std::uint64_t at(int x, int y) const
  {
    return RandomBits(this->seed,
                      static_cast<std::uint64_t>(y) * this->width + static_cast<std::uint64_t>(x));
  }
};

inline PixelStreams StreamsOf(const Frame& frame)
{
  return {RandomBits(frame.seed, frame.frameIndex), static_cast<std::uint64_t>(frame.width)};
}

/// SampleWalker's jitter: random, as noise disturbs less than bands do (its counter is one that no
/// sample has); but of extremes, and where both ends of samples are looked at, both of a ray count.
INR_HOST_DEVICE inline double JitterOf(const MarchSettings& settings, std::uint64_t stream)
{
  const bool ends = settings.projector.isExtreme() || settings.looksAtBothEnds();
  return ends ? 1.0 : RandomUnit(stream, ~std::uint64_t{0});
}

/// Samples of a ray that are placed at once where each asks the network: enough to fill a batch,
/// few enough not to overshoot an opaque surface.
constexpr int SamplesPerRound = 8;

/// A sample to infer and what its answer is good for.
struct MarchSample
{
  glm::vec3 position; ///< in the unit cube
  ValueRange range;   ///< of its macro-cells
  float length;       ///< it stands for, in opacity unit distances
  float t;
  double begin; ///< t of what it stands for
  double end;
};

/// Where a field is asked for at a point of a ray: inside a slab of a single voxel, always at it.
INR_HOST_DEVICE inline glm::vec3 FieldPosition(const MarchSettings& settings,
                                               const glm::dvec3& index)
{
  const glm::dvec3 inside = glm::clamp(index, glm::dvec3(0.0), settings.dims - 1.0);
  return glm::vec3((inside + 0.5) / settings.dims);
}

/// Places up to `most` samples of a ray, skipping what cannot be seen; fewer only at the ray's end.
INR_HOST_DEVICE inline int PlaceSamples(const MarchSettings& settings, MarchState& state, int most,
                                        MarchSample* samples)
{
  const Ray& ray = state.ray;
  SampleWalker& walker = state.samples;
  int count = 0;
  while (count < most && walker.moveToVisible(settings)) {
    const AlikeSamples alike = walker.alike();
    if (settings.projector.canSkip(state.projection, walker.stretch().range)) {
      walker.pass(alike, alike.count);
      continue;
    }
    const auto steps = alike.last ? walker.rest() : static_cast<double>(alike.steps());
    const double place = static_cast<double>(walker.next()) + walker.offset(alike);
    const double t = glm::min(place * settings.step, ray.length);
    if (settings.crops && !settings.cropping.shows(ray.at(t))) {
      walker.pass(alike, 1);
      continue;
    }
    samples[count++] = {FieldPosition(settings, ray.at(t)),
                        walker.stretch().range,
                        static_cast<float>(steps * settings.step * settings.unitsPerT),
                        static_cast<float>(t),
                        static_cast<double>(walker.next()) * settings.step,
                        static_cast<double>(walker.next() + alike.steps()) * settings.step};
    walker.pass(alike, 1);
  }
  return count;
}

/// Moves a network output into the range of its macro-cells, so that the majorant holds; tells
/// whether it was outside.
INR_HOST_DEVICE inline bool ClampToRange(const ValueRange& range, float& value)
{
  const float inside = value > range.low ? (value < range.high ? value : range.high) : range.low;
  const bool outside = inside != value;
  value = inside;
  return outside;
}

/// Front-to-back over operator with opacity corrected for the sample's length:
/// 1 - (1 - alpha)^length.
INR_HOST_DEVICE inline void Composite(const glm::vec4& entry, const MarchSample& sample,
                                      MarchState& state)
{
  if (entry.w <= 0.0f) {
    return;
  }
  const float alpha = OpacityOver(sample.length, entry.w);
  const double weight = (1.0 - state.color.w) * alpha;
  state.color += glm::dvec4(entry.x, entry.y, entry.z, 1.0) * weight;
  if (state.halfOpaqueAt < 0 && state.color.w >= 0.5f) {
    state.halfOpaqueAt = sample.t;
  }
}

/// Sends a ray on behind the translucent layer at its end, but for its samples; false when there is
/// no more to see.
INR_HOST_DEVICE inline bool EnterNextPart(const RayView& rays, int x, int y, MarchState& state)
{
  if (!state.layered.enterNextPart(rays, rays.pixel(x, y), state.ray, glm::vec3(state.color),
                                   static_cast<float>(1.0 - state.color.w), state.halfOpaqueAt)) {
    return false;
  }
  state.ray = rays.ray(x, y, state.layered.part);
  state.knownAt = -1;
  return true;
}

/// What a ray that has ended shows, premultiplied.
INR_HOST_DEVICE inline glm::vec4 ShownColor(const MarchState& state, const Projector& projector,
                                            const ColorLookup& colors, const RayView& rays)
{
  if (rays.layers.any()) {
    LayeredLight light = state.layered.light;
    light.gather(glm::vec3(state.color), static_cast<float>(1.0 - state.color.w));
    return {light.seen(), static_cast<float>(state.color.w)};
  }
  return projector.projects() && state.ray.length > 0 ? projector.color(colors, state.projection)
                                                      : glm::vec4(state.color);
}

/// Window-space depth where it was half opaque, or of what it projects; 1 = nowhere.
INR_HOST_DEVICE inline double ShownDepth(const MarchState& state, const Projector& projector,
                                         const ColorLookup& colors, const RayView& rays)
{
  if (state.layered.halfOpaqueDepth >= 0) {
    return state.layered.halfOpaqueDepth;
  }
  const bool shows = projector.projects() && ShownColor(state, projector, colors, rays).w >= 0.5f;
  const double t = shows ? state.projection.at : state.halfOpaqueAt;
  return t >= 0 ? rays.windowDepth(state.ray.at(t)) : 1.0;
}

} // namespace inr
