// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MacroCells/CellBlock.h"

#include <cstdint>

namespace inr {

/// What a macro-cell's samples may be, numbered from the fewest samples on: 2^3 steps apart from
/// level 3, then from level 0; 2^2 steps apart from level 2, then from level 0; ...; and, behind
/// these SampleChoices, all samples of the full resolution. A level never has larger voxels than
/// its samples are apart, as these would miss what is in between.
constexpr int SampleChoices = 2 * LargestCellPower;

inline CellSampling SampleChoice(int number)
{
  const auto power = static_cast<std::uint8_t>((SampleChoices + 1 - number) / 2);
  return {number % 2 == 0 ? power : std::uint8_t{0}, power};
}

/// Of a choice that SampleChoice may give, but all samples.
inline int NumberOf(const CellSampling& choice)
{
  return SampleChoices - 2 * choice.power + (choice.level == 0 ? 1 : 0);
}

} // namespace inr
