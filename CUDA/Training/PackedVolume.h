// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Training/Kernels/TrainDraw.h"
#include "Core/Training/Samples/SampleSource.h"
#include "Core/Training/Samples/StratifiedPositions.h"
#include "Core/Training/Volume/Scalars.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace inr {
namespace cuda {

/// A copy of a volume in a machine's memory, and mini-batches of so many samples out of it.
template <class Machine> class PackedVolume
{
public:
  PackedVolume(Machine& machine, const NormalisedVolume& volume, std::int64_t samples)
      : Bytes(machine.template allocate<char>(
            volume.data.voxels() * static_cast<std::int64_t>(ScalarSize(volume.data.type)))),
        Corners(machine.template allocate<float>(3 * samples)), Count(samples)
  {
    const glm::i64vec3& dims = volume.data.dims;
    this->View = {this->Bytes.data(),
                  volume.data.type,
                  {dims.x, dims.y, dims.z},
                  volume.low,
                  volume.high - volume.low};
    VisitScalars(volume.data,
                 [&](const auto* values) { this->upload(machine, values, volume.data); });
    const StratifiedPositions boxes(dims, samples);
    const HalvedCube& cube = boxes.boxes();
    this->Extent = cube.extent;
    machine.toMachine(this->Corners.data(), &cube.corners.data()->x, 3 * samples);
  }

  void draw(Machine& machine, std::uint64_t stream, std::uint64_t step, float* positions,
            float* targets) const
  {
    machine.run(TrainDraw{this->View,
                          this->Corners.data(),
                          {this->Extent.x, this->Extent.y, this->Extent.z},
                          this->Count,
                          stream,
                          step,
                          positions,
                          targets},
                this->Count);
  }

private:
  template <class T> void upload(Machine& machine, const T* values, const VolumeData& volume)
  {
    using Kept = std::conditional_t<IsVast<T>, double, T>;
    static_assert(sizeof(Kept) == sizeof(T));
    auto* const to = reinterpret_cast<Kept*>(this->Bytes.data());
    const double origin = this->View.origin;
    if constexpr (IsVast<T>) { // devices have no wider type to subtract in
      this->View.type = ScalarType::Float64;
      this->View.origin = 0.0;
      this->convert(machine, volume.voxels(), to,
                    [&](std::int64_t k) { return Above(values[k * volume.stride], origin); });
    } else if (volume.stride != 1) {
      this->convert(machine, volume.voxels(), to,
                    [&](std::int64_t k) { return values[k * volume.stride]; });
    } else {
      machine.toMachine(to, values, volume.voxels());
    }
  }

  template <class T, class ValueOf>
  static void convert(Machine& machine, std::int64_t count, T* to, const ValueOf& valueOf)
  {
    constexpr std::int64_t most = 1 << 20;
    std::vector<T> piece(static_cast<std::size_t>(std::min(count, most)));
    for (std::int64_t first = 0; first < count; first += most) {
      const std::int64_t size = std::min(most, count - first);
      for (std::int64_t k = 0; k < size; ++k) {
        piece[static_cast<std::size_t>(k)] = valueOf(first + k);
      }
      machine.toMachine(to + first, piece.data(), size);
    }
  }

  typename Machine::template Array<char> Bytes;
  typename Machine::template Array<float> Corners;
  std::int64_t Count;
  glm::vec3 Extent{1.0f};
  DeviceVolume View{};
};

} // namespace cuda
} // namespace inr
