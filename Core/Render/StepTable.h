// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/BrickKernel.h"
#include "Core/Render/ColorTable.h"

#include <vector>

namespace inr {

/// A colour table with its opacities corrected for samples of 1, 2, 4, ... steps:
/// 1 - (1 - opacity)^length. Between the entries of the colour table as many are put as linear
/// interpolation needs to follow the power within 2e-4 of it, up to 2^14 rows.
class StepTable
{
public:
  /// `stepLength` in opacity unit distances, above 0; `multiples` tables, for samples of
  /// 1 ... 2^(multiples - 1) steps.
  StepTable(const ColorLookup& colors, double stepLength, int multiples);

  /// Over normalised values, or over ColorLookup::coordinate for a logarithmic colour table.
  const StepLookup& lookup() const { return this->Lookup; }
  bool fits(double stepLength, int multiples) const
  {
    return this->StepLength == stepLength && this->Multiples == multiples;
  }

private:
  double StepLength;
  int Multiples;
  std::vector<glm::vec4> Entries;
  StepLookup Lookup{};
};

} // namespace inr
