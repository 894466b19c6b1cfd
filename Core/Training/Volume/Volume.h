// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"
#include "Core/Model/Model.h"
#include "Core/Parallel.h"

#include <glm/gtc/type_precision.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace inr {

/// A view of somebody's scalar array: x fastest, `stride` elements from one voxel to the next.
struct VolumeData
{
  const void* values = nullptr;
  ScalarType type = ScalarType::Float32;
  glm::i64vec3 dims{0};
  std::int64_t stride = 1;

  std::int64_t voxels() const { return GridCount(this->dims); }
};

/// Part of a volume that is in memory: the box of `data.dims` voxels from voxel `first` on.
struct VolumePiece
{
  VolumeData data;
  glm::i64vec3 first{0};
};

/// What one pass over the data tells.
struct VolumeStatistics
{
  /// Smallest and largest finite value; low > high when there is none. Of integers that no double
  /// is, the next double beyond.
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  /// The largest of the doubles below values, and the smallest of those above.
  double innerLow = -std::numeric_limits<double>::infinity();
  double innerHigh = std::numeric_limits<double>::infinity();
  std::int64_t nonFinite = 0;
  /// The largest distance of an integer from the double below it, and from that above.
  double overLow = 0;
  double underHigh = 0;

  bool hasValues() const { return this->low <= this->high; }
  /// Whether doubles tell no value from another.
  bool isConstant() const { return this->low == this->innerLow && this->high == this->innerHigh; }
  /// Of one that is constant: the double nearest to its values, and the largest distance from it.
  double nearest() const { return this->overLow <= this->underHigh ? this->low : this->high; }
  double distance() const { return std::min(this->overLow, this->underHigh); }
  void add(const VolumeStatistics& other);
};
VolumeStatistics MeasureVolume(const VolumeData& volume, const Arena& arena);

/// The same of a box within a piece.
VolumeStatistics MeasureBox(const VolumePiece& piece, const GridBox& box, const Arena& arena);

} // namespace inr
