// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Core/Render/Scene/ColorTable.h"
#include "Core/Render/Scene/SparseTable.h"

#include <vector>

namespace inr {

/// By how much a pixel changes when the values along its ray do.
///
/// A step of opacity A and colour c in front of light B from behind leaves c A + (1 - A) B of each
/// channel, which changes by (c A)' - A' B per value: something between the slopes for B = 0 and
/// for the brightest B, and, by the mean value theorem, between the smallest and the largest slope
/// in a range of values, if nothing leaves that. So what n steps through a range add to a pixel is
/// off by no more than |middle| times the sum of what their values are off by, plus `half` times
/// the sum of its magnitudes, as long as what lies in front hides as much of each of them.
class ColorSensitivity
{
public:
  /// For steps of `stepLength` opacity unit distances, above 0.
  ColorSensitivity(const ColorLookup& colors, double stepLength);

  /// The slopes in a range: middle - half to middle + half, or the same with another sign. Per
  /// normalised value; of all channels the largest.
  struct Slopes
  {
    float middle = 0;
    float half = 0;  ///< infinite where colours jump in the range, or change as fast as that
    float depth = 0; ///< optical depth of a step that all values have at least
  };
  Slopes slopes(const ValueRange& range) const;

private:
  /// Of one slope, over table intervals.
  struct Extremes
  {
    SparseTable<Minimum> smallest;
    SparseTable<Maximum> largest;
  };

  ColorLookup Colors;
  bool JumpsBelow; ///< where the table begins
  bool JumpsAbove;
  std::vector<Extremes> Channels; ///< per table entry
  SparseTable<Minimum> Depths;    ///< of a step
  float DepthBelow;
  float DepthAbove;
};

} // namespace inr
