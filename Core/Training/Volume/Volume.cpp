// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Volume/Volume.h"

#include "Core/GridBox.h"
#include "Core/Training/Volume/Scalars.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inr {

namespace {

template <class T>
void MeasureRow(const T* values, std::int64_t stride, std::int64_t count, VolumeStatistics& result)
{
  for (std::int64_t k = 0; k < count; ++k) {
    const T value = values[k * stride];
    if (!std::isfinite(static_cast<double>(value))) {
      ++result.nonFinite;
      continue;
    }
    const double below = DoubleBelow(value);
    const double above = DoubleAbove(value);
    result.low = std::min(result.low, below);
    result.innerLow = std::max(result.innerLow, below);
    result.high = std::max(result.high, above);
    result.innerHigh = std::min(result.innerHigh, above);
    if constexpr (IsVast<T>) {
      result.overLow = std::max(result.overLow, Above(value, below));
      result.underHigh = std::max(result.underHigh, -Above(value, above));
    }
  }
}

} // namespace

void VolumeStatistics::add(const VolumeStatistics& other)
{
  this->low = std::min(this->low, other.low);
  this->high = std::max(this->high, other.high);
  this->innerLow = std::max(this->innerLow, other.innerLow);
  this->innerHigh = std::min(this->innerHigh, other.innerHigh);
  this->nonFinite += other.nonFinite;
  this->overLow = std::max(this->overLow, other.overLow);
  this->underHigh = std::max(this->underHigh, other.underHigh);
}

VolumeStatistics MeasureBox(const VolumePiece& piece, const GridBox& box, const Arena& arena)
{
  constexpr std::int64_t rowsAtATime = 64;
  const glm::i64vec3 size = piece.data.dims;
  const glm::i64vec3 offset = box.first - piece.first;
  const std::int64_t rows = box.size.y * box.size.z;
  std::vector<VolumeStatistics> parts(
      static_cast<std::size_t>((rows + rowsAtATime - 1) / rowsAtATime));
  VisitScalars(piece.data, [&](const auto* values) {
    arena.forEachBlock(rows, rowsAtATime, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t row = begin; row < end; ++row) {
        const std::int64_t y = offset.y + row % box.size.y;
        const std::int64_t z = offset.z + row / box.size.y;
        const std::int64_t first = GridNumber({offset.x, y, z}, size);
        MeasureRow(values + first * piece.data.stride, piece.data.stride, box.size.x,
                   parts[static_cast<std::size_t>(begin / rowsAtATime)]);
      }
    });
  });
  VolumeStatistics all;
  for (const VolumeStatistics& part : parts) {
    all.add(part);
  }
  return all;
}

VolumeStatistics MeasureVolume(const VolumeData& volume, const Arena& arena)
{
  const glm::i64vec3 origin(0);
  return MeasureBox({volume, origin}, {origin, volume.dims}, arena);
}

} // namespace inr
