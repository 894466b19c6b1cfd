// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/HostDevice.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// Normalised values a cell can show; low > high means that the cell is empty.
struct ValueRange
{
  float low = 1.0f;
  float high = -1.0f;

  INR_HOST_DEVICE bool empty() const { return this->low > this->high; }
  bool operator==(const ValueRange& other) const
  {
    return this->low == other.low && this->high == other.high;
  }
  INR_HOST_DEVICE void extend(float value)
  {
    const bool first = this->empty();
    this->low = first || value < this->low ? value : this->low;
    this->high = first || value > this->high ? value : this->high;
  }
  INR_HOST_DEVICE void extend(const ValueRange& other)
  {
    if (!other.empty()) {
      this->extend(other.low);
      this->extend(other.high);
    }
  }
};

/// Where the ranges come from, in falling order of trust.
enum class MacroCellProvenance {
  Decoded,  ///< every voxel of the stored network, with an apron
  Training, ///< every voxel of the data, with an apron, widened by the measured maximum error
  File      ///< whatever the writing program put there (upstream)
};

/// Value ranges of a coarse regular grid over the unit cube; the data half of empty-space skipping
/// (the other half, majorants, also knows the transfer function and lives in Render/).
/// Cell (x, y, z) covers [x*spacing.x, (x+1)*spacing.x] and so on; the last cells may overhang 1.
struct MacroCells
{
  glm::i64vec3 dims{0};
  glm::dvec3 spacing{0}; ///< cell edge in the unit cube
  glm::dvec3 apron{0};   ///< ranges hold what is so close to their cell, too; in the unit cube
  MacroCellProvenance provenance = MacroCellProvenance::File;
  std::vector<ValueRange> ranges; ///< x fastest

  bool empty() const { return this->ranges.empty(); }
  bool operator==(const MacroCells& other) const
  {
    return this->dims == other.dims && this->spacing == other.spacing &&
           this->apron == other.apron && this->provenance == other.provenance &&
           this->ranges == other.ranges;
  }
  /// Whether no voxel that was measured lies outside its cell's range: of others' files that is
  /// only hoped. What lies between these voxels, as those of a ScaledModel do, may leave it.
  bool rangesHold() const { return this->empty() || this->provenance != MacroCellProvenance::File; }
  std::int64_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return GridNumber({x, y, z}, this->dims);
  }
};

/// Throws Error(`code`) unless the cells cover the unit cube, with edges of at most 1e9 of it
/// (those of a single layer of voxels reach far beyond it), and the apron is finite and not
/// negative.
void RequireValidGeometry(const MacroCells& cells, ErrorCode code);

/// Edge in voxels of the cells for a volume: the smallest power of two >= 16 that gives at most
/// 2^22 cells.
int DefaultMacroCellSize(const glm::i64vec3& volumeDims);

/// How many cells of `edge` voxels cover a volume. Throws Error(InvalidArgument) where there is no
/// such volume or cell, Error(TooLarge) where they are too many for a file.
std::int64_t CountMacroCells(const glm::i64vec3& volumeDims, int edge);

/// An empty-ranged grid with cells of `edge` voxels over a volume of `volumeDims` voxels. Throws
/// what CountMacroCells throws.
MacroCells MakeMacroCells(const glm::i64vec3& volumeDims, int edge);

} // namespace inr
