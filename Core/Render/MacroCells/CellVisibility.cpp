// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MacroCells/CellVisibility.h"

#include <algorithm>

namespace inr {

namespace {

bool Overlap(const ValueRange& a, const ValueRange& b)
{
  return !a.empty() && !b.empty() && a.low <= b.high && b.low <= a.high;
}

/// Of data values.
ValueRange Normalised(double low, double high, const VolumeInfo& volume)
{
  const double width = volume.high - volume.low;
  if (!(width > 0)) {
    const bool holds = low <= volume.low && volume.low <= high;
    return holds ? ValueRange{0.0f, 1.0f} : ValueRange{};
  }
  return {static_cast<float>((low - volume.low) / width),
          static_cast<float>((high - volume.low) / width)};
}

template <typename Matters> ExtinctionRule RuleOf(Matters matters)
{
  return [matters](const ValueRange* ranges, std::int64_t count, float* extinctions) {
    std::transform(ranges, ranges + count, extinctions,
                   [&](const ValueRange& range) { return matters(range) ? 1.0f : 0.0f; });
  };
}

} // namespace

ExtinctionRule VisibilityFor(const Projector& projector, const ColorTable& colors)
{
  if (projector.mode == BlendMode::Composite || projector.mode == BlendMode::Additive) {
    return [&colors](const ValueRange* ranges, std::int64_t count, float* extinctions) {
      colors.maximumExtinctions(ranges, count, extinctions);
    };
  }
  if (projector.findsSurfaces()) {
    return RuleOf([surfaces = projector.surfaces](const ValueRange& range) {
      return !range.empty() && surfaces.meets(range);
    });
  }
  const ValueRange seen = projector.isExtreme() ? ValueRange{0.0f, 1.0f} : projector.averaged;
  return RuleOf([seen](const ValueRange& range) { return Overlap(range, seen); });
}

Projector ProjectorFor(const Blending& blending, const VolumeInfo& volume, const ValueRange& bounds,
                       const std::vector<float>& surfaces)
{
  return {blending.mode,
          {surfaces.data(), static_cast<int>(surfaces.size())},
          Normalised(blending.averageLow, blending.averageHigh, volume),
          bounds};
}

} // namespace inr
