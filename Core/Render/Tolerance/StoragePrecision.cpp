// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/StoragePrecision.h"

#include "Core/Render/Scene/ColorTable.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Render/Tolerance/ColorSensitivity.h"
#include "Core/Render/Tolerance/LevelChooser.h"

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// A brick of all normalised values has 2^16 - 1 steps; half of one is rounded, and some room.
constexpr double Rounding = 0x1p-16;
constexpr double Share = 1.0 / 8; ///< of the tolerance

/// Of the volume, where lengths of the medium are measured: of the four diagonals one is the
/// longest.
double LongestWay(const Frame& frame, const glm::i64vec3& dims)
{
  const glm::dmat3 toMedium = frame.worldToMedium * glm::inverse(glm::dmat3(frame.worldToIndex));
  const glm::dvec3 extent(dims);
  double longest = 0;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      longest = std::max(longest, glm::length(toMedium * (extent * glm::dvec3(x, y, 1.0))));
    }
  }
  return longest;
}

/// By how much a pixel may change for what 16 bits round.
double LargestChange(const Frame& frame, const TransferFunction& colors, const VolumeInfo& volume)
{
  constexpr double steps = 1024; // so many that their opacities add up
  const ColorTable table(colors, volume);
  const double way = LongestWay(frame, volume.dims) / frame.unitDistance;
  const ColorSensitivity::Slopes slopes =
      ColorSensitivity(table.lookup(), way / steps).slopes({0.0f, 1.0f});
  return steps * Rounding * (static_cast<double>(slopes.middle) + static_cast<double>(slopes.half));
}

} // namespace

CachePrecision PrecisionWithin(const Frame& frame, const TransferFunction& colors,
                               const VolumeInfo& volume, bool rangesHold)
{
  const double tolerance = frame.errorTolerance.value_or(0) / 255;
  const bool shows = !LevelChooser::choosesFor(frame, rangesHold) ||
                     !(LargestChange(frame, colors, volume) <= Share * tolerance);
  return shows ? CachePrecision::Float32 : CachePrecision::Bits16;
}

} // namespace inr
