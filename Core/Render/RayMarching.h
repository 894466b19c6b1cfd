// SPDX-License-Identifier: BSD-3-Clause
//
// The stages of ray marching, as functions over one ray; a tile runs each over its live rays.
#pragma once

#include "Core/HostDevice.h"
#include "Core/Random.h"
#include "Core/Render/MajorantGrid.h"
#include "Core/Render/Ray.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>

namespace inr {

/// What the stages share within a frame.
struct MarchSettings
{
  glm::dvec3 dims{1.0};   ///< voxels per axis
  double step = 0.5;      ///< t between samples
  double unitsPerT = 1.0; ///< opacity unit distances per unit of t
  bool adaptive = true;   ///< Frame::adaptiveSampling
};

/// Where a ray stands. Its samples sit on a lattice of its own, t = (k + jitter) * step, so that
/// what is skipped does not move what follows.
struct MarchState
{
  Ray ray;
  double jitter = 0;        ///< in [0, 1)
  std::int64_t next = 0;    ///< lattice interval to look at next
  glm::vec4 color{0};       ///< premultiplied, so far
  double halfOpaqueAt = -1; ///< t where opacity reached one half; -1 = not yet
};

/// The random stream of a pixel's ray.
INR_HOST_DEVICE inline std::uint64_t PixelStream(const Frame& frame, int x, int y)
{
  const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(frame.width) +
                     static_cast<std::uint64_t>(x);
  return RandomBits(RandomBits(frame.seed, frame.frameIndex), pixel);
}

/// MarchState::jitter; its counter is one that no sample has.
INR_HOST_DEVICE inline double JitterOf(std::uint64_t stream)
{
  return RandomUnit(stream, ~std::uint64_t{0});
}

/// A sample to infer and what its answer is good for.
struct MarchSample
{
  glm::vec3 position; ///< in the unit cube
  ValueRange range;   ///< of its macro-cell
  float length;       ///< it stands for, in opacity unit distances
  float t;
};

/// Optical depth that needs no finer sampling.
constexpr double FaintDepth = 0.05;

/// Opacity at which the rest of a ray no longer shows.
constexpr float OpaqueEnough = 0.999f;
constexpr float OpaqueTransmittance = 1.0f - OpaqueEnough;

/// The macro-cell of a point in the unit cube, and where the ray leaves it.
struct CellVisit
{
  float extinction; ///< see MajorantGrid
  ValueRange range;
  double exit; ///< t, above the t of the visit
};

INR_HOST_DEVICE inline CellVisit VisitCell(const MajorantGrid& majorants,
                                           const MarchSettings& settings, const Ray& ray, double t)
{
  const glm::dvec3 u = (ray.at(t) + 0.5) / settings.dims;
  glm::i64vec3 at;
  double exit = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = majorants.spacing()[axis];
    const auto last = static_cast<double>(majorants.dims()[axis] - 1);
    const double cell = glm::clamp(std::floor(u[axis] / edge), 0.0, last);
    at[axis] = static_cast<std::int64_t>(cell);
    const double slope = ray.direction[axis] / settings.dims[axis];
    // The outermost cells reach as far as the ray does.
    if (slope > 0 && cell < last) {
      exit = glm::min(exit, t + ((cell + 1.0) * edge - u[axis]) / slope);
    } else if (slope < 0 && cell > 0) {
      exit = glm::min(exit, t + (cell * edge - u[axis]) / slope);
    }
  }
  const std::int64_t cell = majorants.index(at);
  return {majorants.extinction(cell), majorants.range(cell), exit};
}

/// Where a field is asked for at a point of a ray: inside a slab of a single voxel, always at it.
INR_HOST_DEVICE inline glm::vec3 FieldPosition(const MarchSettings& settings,
                                               const glm::dvec3& index)
{
  const glm::dvec3 inside = glm::clamp(index, glm::dvec3(0.0), settings.dims - 1.0);
  return glm::vec3((inside + 0.5) / settings.dims);
}

/// How many lattice intervals one sample may stand for: more where little can be seen. The interval
/// must start on a multiple of its size and end inside the cell.
INR_HOST_DEVICE inline int StepsAtOnce(const MarchSettings& settings, std::int64_t k,
                                       float extinction, double exit)
{
  const int most = settings.adaptive ? 4 : 1;
  int steps = 1;
  while (steps < most) {
    const int doubled = 2 * steps;
    const double length = doubled * settings.step * settings.unitsPerT;
    if (k % doubled != 0 || static_cast<double>(k + doubled) * settings.step > exit ||
        extinction * length > FaintDepth) {
      break;
    }
    steps = doubled;
  }
  return steps;
}

/// Places up to `most` samples of a ray, skipping what cannot be seen; fewer only at the ray's end.
INR_HOST_DEVICE inline int PlaceSamples(const MajorantGrid& majorants,
                                        const MarchSettings& settings, MarchState& state, int most,
                                        MarchSample* samples)
{
  const Ray& ray = state.ray;
  int count = 0;
  while (count < most) {
    const double begin = static_cast<double>(state.next) * settings.step;
    if (begin >= ray.length) {
      break;
    }
    const double t = glm::min(begin + state.jitter * settings.step, ray.length);
    const CellVisit visit = VisitCell(majorants, settings, ray, t);
    if (visit.extinction <= 0.0f) {
      const double past = std::ceil(visit.exit / settings.step - state.jitter);
      state.next = glm::max(state.next + 1, static_cast<std::int64_t>(past));
      continue;
    }
    const int steps = StepsAtOnce(settings, state.next, visit.extinction, visit.exit);
    const double end =
        glm::min(static_cast<double>(state.next + steps) * settings.step, ray.length);
    const double at = glm::min(begin + state.jitter * steps * settings.step, ray.length);
    samples[count++] = {FieldPosition(settings, ray.at(at)), visit.range,
                        static_cast<float>((end - begin) * settings.unitsPerT),
                        static_cast<float>(at)};
    state.next += steps;
  }
  return count;
}

/// Moves a network output into its macro-cell's range, so that the majorant holds; tells whether it
/// was outside.
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
  const float alpha = 1.0f - std::pow(1.0f - entry.w, sample.length);
  const float weight = (1.0f - state.color.w) * alpha;
  state.color += glm::vec4(entry.x, entry.y, entry.z, 1.0f) * weight;
  if (state.halfOpaqueAt < 0 && state.color.w >= 0.5f) {
    state.halfOpaqueAt = sample.t;
  }
}

} // namespace inr
