// SPDX-License-Identifier: BSD-3-Clause
//
// Opacity and extinction: 1 - exp(-depth) is the opacity of an optical depth, which is extinction
// times length (Max, "Optical models for direct volume rendering", IEEE TVCG 1(2), 1995). Opacities
// are 0 to 1, lengths above 0 in opacity unit distances, and extinctions per such distance. What
// the inner loops look up instead of computing it is in Marching/StepTable.h.
#pragma once

#include "Core/HostDevice.h"

#include <cmath>

namespace inr {

/// Of what has this opacity over a unit distance; infinite for 1. Of floating point numbers.
template <class T> T ExtinctionOf(T opacity) { return -std::log1p(-opacity); }

/// Of an optical depth. Of floating point numbers.
template <class T> INR_HOST_DEVICE T OpacityOf(T depth) { return -std::expm1(-depth); }

/// Over a length, of what has this opacity over a unit distance: 1 - (1 - opacity)^length.
inline double OpacityOver(double length, double opacity)
{
  return opacity < 1.0 ? OpacityOf(length * ExtinctionOf(opacity)) : 1.0;
}

/// The same for inner loops, to within 3e-6 and, relatively, 1e-3.
INR_HOST_DEVICE inline float OpacityOver(float length, float opacity)
{
  // The power is faster, but what is faint or short it loses to rounding.
  const bool isFaint = opacity < 0x1p-8f || length < 0x1p-6f;
  return isFaint ? -std::expm1(length * std::log1p(-opacity))
                 : 1.0f - std::pow(1.0f - opacity, length);
}

/// Extinction for inner loops that must be finite: opacities from 1 - 2^-20 on count as that.
INR_HOST_DEVICE inline float FiniteExtinctionOf(float opacity)
{
  // The logarithm is twice as fast as that of one plus something, whose series is good enough for
  // opacities that the difference would round.
  constexpr float faint = 0x1p-10f;
  constexpr float most = 1.0f - 0x1p-20f;
  return opacity < faint ? opacity * (1.0f + opacity * (0.5f + opacity * (1.0f / 3.0f)))
                         : -std::log(1.0f - (opacity < most ? opacity : most));
}

} // namespace inr
