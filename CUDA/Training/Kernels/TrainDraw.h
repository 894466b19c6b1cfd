// SPDX-License-Identifier: BSD-3-Clause
//
// A mini-batch out of a volume in the device's memory, a sample by one thread: positions and
// targets of Core's StratifiedBatches, by the same functions (Core/Training/Samples/Trilinear.h).
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "Core/Model/Model.h"
#include "Core/Training/Samples/Trilinear.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// A volume without gaps. Integers of 64 bits are there as doubles, above the origin.
struct DeviceVolume
{
  const void* values;
  ScalarType type;
  std::int64_t dims[3];
  double origin; ///< to be subtracted
  double range;  ///< of values above the origin
};

/// Calls `function(first value)` with its type.
template <class Function>
INR_HOST_DEVICE inline double WithVoxels(const DeviceVolume& volume, const Function& function)
{
  switch (volume.type) {
  case ScalarType::Int8:
    return function(static_cast<const std::int8_t*>(volume.values));
  case ScalarType::UInt8:
    return function(static_cast<const std::uint8_t*>(volume.values));
  case ScalarType::Int16:
    return function(static_cast<const std::int16_t*>(volume.values));
  case ScalarType::UInt16:
    return function(static_cast<const std::uint16_t*>(volume.values));
  case ScalarType::Int32:
    return function(static_cast<const std::int32_t*>(volume.values));
  case ScalarType::UInt32:
    return function(static_cast<const std::uint32_t*>(volume.values));
  case ScalarType::Float32:
    return function(static_cast<const float*>(volume.values));
  default:
    return function(static_cast<const double*>(volume.values));
  }
}

struct TrainDraw
{
  static constexpr int Threads = 128;

  DeviceVolume volume;
  const float* corners; ///< x, y, z of each of `count` boxes
  float extent[3];      ///< of a box
  std::int64_t count;
  std::uint64_t stream;
  std::uint64_t step;
  float* positions;
  float* targets;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      for (std::int64_t k = std::int64_t{block.index()} * Threads + thread; k < this->count;
           k += stride) {
        this->draw(k);
      }
    });
  }

private:
  INR_HOST_DEVICE void draw(std::int64_t k) const
  {
    const auto boxes = static_cast<std::uint64_t>(this->count);
    const std::uint64_t drawn = this->step * boxes + static_cast<std::uint64_t>(k);
    float* const position = this->positions + 3 * k;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t voxels = this->volume.dims[axis];
      const float free =
          CoordinateInBox(this->corners[3 * k + axis], this->extent[axis], voxels, this->stream,
                          3 * drawn + static_cast<std::uint64_t>(axis));
      position[axis] = IsOfVoxel(drawn, boxes) ? CentreOfVoxel(free, voxels) : free;
    }
    this->targets[k] = NormalisedTarget(this->sample(position), 0.0, this->volume.range);
  }

  INR_HOST_DEVICE double sample(const float* position) const
  {
    const std::int64_t* const dims = this->volume.dims;
    const SampledAxis x{dims[0], 0, dims[0], 1};
    const SampledAxis y{dims[1], 0, dims[1], dims[0]};
    const SampledAxis z{dims[2], 0, dims[2], dims[0] * dims[1]};
    return WithVoxels(this->volume, [&](const auto* voxels) {
      return SampleVoxels(x.taps(position[0]), y.taps(position[1]), z.taps(position[2]),
                          [&](std::int64_t offset) {
                            return static_cast<double>(voxels[offset]) - this->volume.origin;
                          });
    });
  }
};

} // namespace cuda
} // namespace inr
