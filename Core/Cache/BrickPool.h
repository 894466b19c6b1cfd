// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CachePrecision.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace inr {

/// A brick's voxels as they are stored; value = low + step * stored, x fastest.
struct BrickView
{
  const void* voxels; ///< float, uint16 or uint8
  float low;
  float step;
};

/// The memory of a cache: a number of slots, each for the voxels of one brick. Memory is the
/// operating system's until a slot is stored to.
class BrickPool
{
public:
  BrickPool(CachePrecision precision, std::int64_t voxelsPerBrick, std::int64_t slots);

  /// Bytes that such a pool takes.
  static std::int64_t bytesFor(CachePrecision precision, std::int64_t voxelsPerBrick,
                               std::int64_t slots);

  CachePrecision precision() const { return this->Precision; }
  std::int64_t slots() const { return static_cast<std::int64_t>(this->Scales.size()); }
  /// `values`: voxelsPerBrick finite ones.
  void store(std::int32_t slot, const float* values);
  BrickView view(std::int32_t slot) const;

private:
  struct Scale
  {
    float low;
    float step;
  };

  unsigned char* brick(std::int32_t slot) const
  {
    return this->Voxels.get() + slot * this->BytesPerBrick;
  }

  CachePrecision Precision;
  std::int64_t VoxelsPerBrick;
  std::int64_t BytesPerBrick;
  std::unique_ptr<unsigned char[]> Voxels; ///< with room behind, for loads of a voxel and the next
  std::vector<Scale> Scales;
};

} // namespace inr
