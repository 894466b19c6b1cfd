// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickView.h"
#include "Core/Cache/CachePrecision.h"
#include "Core/Cache/ReservedArray.h"
#include "Core/Model/MacroCells.h"

#include <cstdint>

namespace inr {

/// The memory of a cache: slots, each for the voxels of one brick.
class BrickPool
{
public:
  /// Addresses for `room` slots, of which there are none yet.
  BrickPool(CachePrecision precision, std::int64_t voxelsPerBrick, std::int64_t room);

  static std::int64_t bytesPerSlot(CachePrecision precision, std::int64_t voxelsPerBrick);

  CachePrecision precision() const { return this->Precision; }
  std::int64_t slots() const { return this->Scales.size(); }
  /// `slots`: no more than there is room for. The memory of those that go is given back.
  void resize(std::int64_t slots);
  void copy(std::int32_t from, std::int32_t to);
  /// `values`: voxelsPerBrick finite ones. `within`: what integers divide evenly, whatever the
  /// values, which they are moved into; where it is empty, the range of the values is. So the whole
  /// brick and what of it can be seen are rounded to the same.
  void store(std::int32_t slot, const float* values, const ValueRange& within = {});
  BrickView view(std::int32_t slot) const;

private:
  struct Scale
  {
    float low;
    float step;
  };

  unsigned char* brick(std::int32_t slot) const
  {
    return this->Voxels.data() + slot * this->BytesPerBrick;
  }

  CachePrecision Precision;
  std::int64_t VoxelsPerBrick;
  std::int64_t BytesPerBrick;
  ReservedArray<unsigned char> Voxels; ///< with room behind, for loads of a voxel and the next
  ReservedArray<Scale> Scales;
};

} // namespace inr
