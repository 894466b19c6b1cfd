// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace inr {

/// How the values along a ray become a colour; as vtkVolumeMapper's blend modes. All but
/// Composite and Isosurface are projections.
enum class BlendMode : std::uint8_t {
  Composite,        ///< each sample's colour over those behind it
  MaximumIntensity, ///< colour and opacity, not corrected for any length, of the largest value
  MinimumIntensity, ///< of the smallest one
  /// Grey, opaque: the mean over the ray's length of value times opacity, of values in
  /// Blending::averageLow to averageHigh only; a value counts as 0 at the low end of the volume's
  /// range and as 1 at its high end. Nothing where there are none.
  AverageIntensity,
  Additive, ///< grey, opaque: such values times opacity, integrated over opacity unit distances
  /// Wherever the field takes one of Blending::isosurfaces, the colour, lit, and the opacity of
  /// that, not corrected for any length, over those behind it.
  Isosurface
};

/// See BlendMode.
struct Blending
{
  BlendMode mode = BlendMode::Composite;
  double averageLow = -std::numeric_limits<double>::infinity(); ///< data values
  double averageHigh = std::numeric_limits<double>::infinity();

  std::vector<double> isosurfaces; ///< data values, finite, in any order

  bool projects() const
  {
    return this->mode != BlendMode::Composite && this->mode != BlendMode::Isosurface;
  }
  bool operator==(const Blending& other) const
  {
    return this->mode == other.mode && this->averageLow == other.averageLow &&
           this->averageHigh == other.averageHigh && this->isosurfaces == other.isosurfaces;
  }
  bool operator!=(const Blending& other) const { return !(*this == other); }
};

} // namespace inr
