// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Marching/ColorLookups.h"
#include "Core/Render/Scene/ColorTable.h"

#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace inr {

/// Numbers the lengths of samples: 1, 3, 2, 6, 4, 12, 8 ... steps. This is that of `count`, 1 to 4,
/// times 2^power steps.
INR_HOST_DEVICE constexpr int LengthOf(int count, int power)
{
  return 2 * power + (count == 3 ? 1 : count == 4 ? 4 : 2 * (count - 1));
}
INR_HOST_DEVICE constexpr std::int64_t StepsOf(int length)
{
  return std::int64_t{length % 2 == 0 ? 1 : 3} << (length / 2);
}

/// Opacity unit distances of samples of the length that has this number.
INR_HOST_DEVICE inline float UnitsOf(const StepLookup& steps, int length)
{
  return steps.step * static_cast<float>(StepsOf(length));
}

/// See StepLookup; `length` in opacity unit distances. Rare: what it takes is not for each sample.
INR_HOST_DEVICE INR_CALLED inline float SteepOpacity(float first, float second, float weight,
                                                     float length)
{
  // What a unit distance lets through is linear in between.
  const auto through = [length](float entry) {
    return entry > 1.0f ? 1.0f - entry / SteepEntry : std::exp(std::log1p(-entry) / length);
  };
  const float begin = through(first);
  const float between = begin + (through(second) - begin) * weight;
  return between > 0.0f ? -std::expm1(length * std::log(between)) : 1.0f;
}

/// How many lengths samples may have: up to the coarsest level's, four times as long where it is
/// faint, and up to what cells ask for.
int SampleLengths(int levels);

/// A colour table with its opacities corrected for samples of 1, 3, 2, 6, ... steps:
/// 1 - (1 - opacity)^length. Between the entries of the colour table as many are put as linear
/// interpolation needs to follow the power within 2e-4 of it, up to 2^14 rows, which may end within
/// twice that. Opacities above 1/2 in samples shorter than a unit distance are followed within
/// 1e-2, and where they are left more steeply, marked as steep: see StepLookup. Entries are floats:
/// what lets through less than 2^-25 is opaque.
class StepTable
{
public:
  /// `stepLength` in opacity unit distances, above 0; for the first `lengths` lengths.
  StepTable(const ColorLookup& colors, double stepLength, int lengths);

  /// Over normalised values, or over ColorLookup::coordinate for a logarithmic colour table.
  const StepLookup& lookup() const { return this->Lookup; }
  /// Behind lookup().entries.
  std::int64_t count() const { return static_cast<std::int64_t>(this->Entries.size()); }
  bool fits(double stepLength, int lengths) const
  {
    return this->StepLength == stepLength && this->Lengths == lengths;
  }

private:
  double StepLength;
  int Lengths;
  std::vector<glm::vec4> Entries;
  StepLookup Lookup{};
};

} // namespace inr
