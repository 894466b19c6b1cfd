// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Volume.h"

#include "Core/Training/Scalars.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inr {

namespace {

constexpr std::int64_t BlockSize = 1 << 18;

struct Extent
{
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  std::int64_t nonFinite = 0;
};

template <class T>
Extent MeasureBlock(const T* values, std::int64_t stride, std::int64_t begin, std::int64_t end)
{
  Extent extent;
  for (std::int64_t k = begin; k < end; ++k) {
    const double value = static_cast<double>(values[k * stride]);
    if (!std::isfinite(value)) {
      ++extent.nonFinite;
      continue;
    }
    extent.low = std::min(extent.low, value);
    extent.high = std::max(extent.high, value);
  }
  return extent;
}

} // namespace

VolumeStatistics MeasureVolume(const VolumeData& volume, const Arena& arena)
{
  const std::int64_t voxels = volume.voxels();
  std::vector<Extent> blocks(static_cast<std::size_t>((voxels + BlockSize - 1) / BlockSize));
  VisitScalars(volume, [&](const auto* values) {
    arena.forEachBlock(voxels, BlockSize, [&](std::int64_t begin, std::int64_t end) {
      blocks[static_cast<std::size_t>(begin / BlockSize)] =
          MeasureBlock(values, volume.stride, begin, end);
    });
  });
  Extent all;
  for (const Extent& block : blocks) {
    all.low = std::min(all.low, block.low);
    all.high = std::max(all.high, block.high);
    all.nonFinite += block.nonFinite;
  }
  return all.nonFinite < voxels ? VolumeStatistics{all.low, all.high, all.nonFinite}
                                : VolumeStatistics{0.0, 0.0, all.nonFinite};
}

} // namespace inr
