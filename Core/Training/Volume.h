// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Parallel.h"

#include <glm/gtc/type_precision.hpp>

#include <cstdint>

namespace inr {

/// A view of somebody's scalar array: x fastest, `stride` elements from one voxel to the next.
struct VolumeData
{
  const void* values = nullptr;
  ScalarType type = ScalarType::Float32;
  glm::i64vec3 dims{0};
  std::int64_t stride = 1;

  std::int64_t voxels() const { return this->dims.x * this->dims.y * this->dims.z; }
};

/// What one pass over the data tells.
struct VolumeStatistics
{
  double low = 0; ///< smallest and largest finite value; 0, 0 when there is none
  double high = 0;
  std::int64_t nonFinite = 0;
};
VolumeStatistics MeasureVolume(const VolumeData& volume, const Arena& arena);

} // namespace inr
