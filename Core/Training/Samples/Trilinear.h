// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of samples and what the voxels around them give, for the host and for devices: the same
// source, so that it is the same to the last bit.
#pragma once

#include "Core/HostDevice.h"
#include "Core/Random.h"

#include <cmath>
#include <cstdint>

namespace inr {

/// Not NaN and not infinite.
INR_HOST_DEVICE inline bool IsFinite(double value) { return value - value == 0.0; }

/// A coordinate in a box of the unit cube: a random number's place between its faces, or the middle
/// of an axis of a single voxel.
INR_HOST_DEVICE inline float CoordinateInBox(float corner, float extent, std::int64_t voxels,
                                             std::uint64_t stream, std::uint64_t counter)
{
  return voxels > 1 ? corner + RandomUnit(stream, counter) * extent : 0.5f;
}

/// The centre of the voxel that a coordinate lies in.
INR_HOST_DEVICE inline float CentreOfVoxel(float coordinate, std::int64_t voxels)
{
  const auto size = static_cast<double>(voxels);
  const double voxel = floor(static_cast<double>(coordinate) * size);
  return static_cast<float>(((voxel < size - 1.0 ? voxel : size - 1.0) + 0.5) / size);
}

/// Whether number `drawn` of so many boxes is moved to the centre of its voxel. By turns: a box
/// gets both kinds from batch to batch.
INR_HOST_DEVICE inline bool IsOfVoxel(std::uint64_t drawn, std::uint64_t boxes)
{
  return (drawn + drawn / boxes) % 2 != 0;
}

/// The two voxels around a coordinate, as element offsets, and the weight of the second.
struct AxisTaps
{
  std::int64_t first;
  std::int64_t second;
  double weight;

  INR_HOST_DEVICE std::int64_t nearest() const
  {
    return this->weight < 0.5 ? this->first : this->second;
  }
};

/// One axis of a piece: voxels of the volume, those of the piece, and elements from one to the
/// next.
struct SampledAxis
{
  std::int64_t whole;
  std::int64_t first;
  std::int64_t size;
  std::int64_t step;

  INR_HOST_DEVICE AxisTaps taps(float u) const
  {
    const auto last = static_cast<double>(this->whole - 1);
    const double beyond = static_cast<double>(u) * static_cast<double>(this->whole) - 0.5;
    const double position = beyond < 0.0 ? 0.0 : (last < beyond ? last : beyond);
    const auto voxel = static_cast<std::int64_t>(position);
    return {this->offset(voxel), this->offset(voxel + 1), position - static_cast<double>(voxel)};
  }

private:
  INR_HOST_DEVICE std::int64_t offset(std::int64_t voxel) const
  {
    const std::int64_t within = voxel - this->first;
    return (within < 0 ? 0 : (within < this->size ? within : this->size - 1)) * this->step;
  }
};

/// What voxels, at(offset), give between them: interpolated in double, so that no type loses
/// digits. Where that is not finite (inf - inf and 0 * inf are NaN, too), the nearest one's.
template <class At>
INR_HOST_DEVICE double SampleVoxels(const AxisTaps& x, const AxisTaps& y, const AxisTaps& z,
                                    const At& at)
{
  const auto mix = [](double a, double b, double weight) { return a + weight * (b - a); };
  const auto row = [&](std::int64_t offset) {
    return mix(at(offset + x.first), at(offset + x.second), x.weight);
  };
  const auto plane = [&](std::int64_t offset) {
    return mix(row(offset + y.first), row(offset + y.second), y.weight);
  };
  const double value = mix(plane(z.first), plane(z.second), z.weight);
  return IsFinite(value) ? value : at(x.nearest() + y.nearest() + z.nearest());
}

/// (value - low)/(high - low) as a target; NaN for one that is not finite.
INR_HOST_DEVICE inline float NormalisedTarget(double value, double low, double high)
{
  // Divided, not multiplied: the inverse of a range of denormal numbers is infinite.
  return IsFinite(value) ? static_cast<float>((value - low) / (high - low)) : NAN;
}

} // namespace inr
